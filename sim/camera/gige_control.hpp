#pragma once

/// Answers GVCP commands: access rights, and the action of each command.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/base/clock.hpp"
#include "sim/camera/camera_fault_script.hpp"
#include "sim/camera/camera_registers.hpp"
#include "sim/camera/gige_streamer.hpp"
#include "sim/camera/gvcp.hpp"
#include "sim/camera/gvsp_sender.hpp"

namespace fvd::sim {

struct GvcpPeer {
  std::uint32_t address = 0;  ///< IPv4, host order
  std::uint16_t port = 0;
  bool operator==(const GvcpPeer&) const = default;
};

/// context: one thread.
class GigeControl {
 public:
  GigeControl(CameraRegisters& registers, GigeStreamer& streamer, GvspSender& sender, CameraFaultScript& faults,
              GigeStreamer::Struck struck)
      : registers_(registers), streamer_(streamer), sender_(sender), faults_(faults), struck_(std::move(struck)) {}

  /// The reply to one datagram; empty = none. A malformed datagram gets no reply, as the standard requires. A request
  /// that a client repeats, because it missed the acknowledge, gets the same acknowledge and is not executed twice.
  [[nodiscard]] std::vector<std::uint8_t> answer(GvcpPeer peer, std::span<const std::uint8_t> packet);

  /// Takes control from a controller that has been silent for the heartbeat timeout.
  void check_heartbeat();

  /// Resets control and registers as after a power cycle.
  void restart();

 private:
  using Bytes = std::vector<std::uint8_t>;

  Bytes execute(GvcpPeer peer, std::span<const std::uint8_t> packet);
  gvcp::Status read_registers(std::span<const std::uint8_t> payload, Bytes& data);
  gvcp::Status read_memory(std::span<const std::uint8_t> payload, Bytes& data);
  gvcp::Status write_registers(GvcpPeer peer, std::span<const std::uint8_t> payload, Bytes& data);
  gvcp::Status write_memory(GvcpPeer peer, std::span<const std::uint8_t> payload, Bytes& data);
  gvcp::Status write(GvcpPeer peer, std::uint32_t at, std::span<const std::uint8_t> bytes);
  gvcp::Status write_privilege(GvcpPeer peer, std::uint32_t value);
  gvcp::Status act_on(std::uint32_t at, std::uint32_t value);
  void resend(std::span<const std::uint8_t> payload);
  void release_control();

  CameraRegisters& registers_;
  GigeStreamer& streamer_;
  GvspSender& sender_;
  CameraFaultScript& faults_;
  const GigeStreamer::Struck struck_;

  std::optional<GvcpPeer> controller_;
  HostTime last_heard_{};
  std::optional<GvcpPeer> last_peer_;
  std::uint16_t last_request_ = 0;
  std::uint16_t last_code_ = 0;
  Bytes last_reply_;
};

}  // namespace fvd::sim
