#pragma once

/// Answers GVCP commands: access rights, and the action of each command.

#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
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

/// What goes back for one datagram.
struct GvcpReply {
  std::vector<std::uint8_t> pending{};      ///< leaves at once; empty = none
  std::chrono::milliseconds delay{0};       ///< until the acknowledge leaves
  std::vector<std::uint8_t> acknowledge{};  ///< empty = none
};

/// context: one thread.
class GigeControl {
 public:
  /// Moves the camera's sockets to an address (IPv4, host order); false if it cannot be had here.
  using Move = std::function<bool(std::uint32_t address)>;

  GigeControl(CameraRegisters& registers, GigeStreamer& streamer, GvspSender& sender, CameraFaultScript& faults,
              GigeStreamer::Struck struck, Move move)
      : registers_(registers),
        streamer_(streamer),
        sender_(sender),
        faults_(faults),
        struck_(std::move(struck)),
        move_(std::move(move)) {}

  /// The reply to one datagram. A malformed datagram gets none, as the standard requires. A request that a client
  /// repeats, because it missed the acknowledge, gets the same acknowledge and is not executed twice, whatever others
  /// asked meanwhile; a request with the same number and other contents is another one.
  [[nodiscard]] GvcpReply answer(GvcpPeer peer, std::span<const std::uint8_t> packet);

  /// The reply to a datagram that went to every device: those that find cameras and give them addresses; empty = none.
  [[nodiscard]] std::vector<std::uint8_t> answer_broadcast(GvcpPeer peer, std::span<const std::uint8_t> packet);

  /// Takes control from a controller that has been silent for the heartbeat timeout.
  void check_heartbeat();

  /// Resets control and registers as after a power cycle, which looks for an address anew.
  void restart();

 private:
  using Bytes = std::vector<std::uint8_t>;

  /// A request that was executed.
  struct Done {
    GvcpPeer peer;
    Bytes packet;
    Bytes acknowledge;
  };

  Bytes execute(GvcpPeer peer, std::span<const std::uint8_t> packet);
  [[nodiscard]] bool may_read(GvcpPeer peer, std::uint32_t at) const;
  gvcp::Status read_registers(GvcpPeer peer, std::span<const std::uint8_t> payload, Bytes& data);
  gvcp::Status read_memory(GvcpPeer peer, std::span<const std::uint8_t> payload, Bytes& data);
  gvcp::Status write_registers(GvcpPeer peer, std::span<const std::uint8_t> payload, Bytes& data);
  gvcp::Status write_memory(GvcpPeer peer, std::span<const std::uint8_t> payload, Bytes& data);
  gvcp::Status write(GvcpPeer peer, std::uint32_t at, std::span<const std::uint8_t> bytes);
  gvcp::Status write_privilege(GvcpPeer peer, std::uint32_t value);
  gvcp::Status act_on(std::uint32_t at, std::uint32_t value);
  void resend(std::span<const std::uint8_t> payload);
  [[nodiscard]] bool is_meant(std::span<const std::uint8_t> payload) const;
  gvcp::Status force_ip(std::span<const std::uint8_t> payload);
  gvcp::Status look_for_address();
  gvcp::Status take_address(std::uint32_t address, std::uint32_t mask, std::uint32_t gateway);
  void release_control();

  CameraRegisters& registers_;
  GigeStreamer& streamer_;
  GvspSender& sender_;
  CameraFaultScript& faults_;
  const GigeStreamer::Struck struck_;
  const Move move_;

  std::optional<GvcpPeer> controller_;
  HostTime last_heard_{};
  std::deque<Done> done_;  // the latest last
};

}  // namespace fvd::sim
