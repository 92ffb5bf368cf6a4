#pragma once

/// Asks a GigE Vision camera whether it is there, beside the control channel of Aravis, whose commands block for 2.5 s
/// when it is not.

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include "core/base/clock.hpp"

namespace fvd {

/// Reads the control privilege register (GigE Vision 1.2, CCP at 0x0A00), which most cameras let everybody read.
/// context: one thread.
class GvcpProbe {
 public:
  /// ip: dotted quad of the camera. Throws Error kCameraDisconnected if there is no way to it.
  explicit GvcpProbe(const std::string& ip);
  ~GvcpProbe();
  GvcpProbe(const GvcpProbe&) = delete;
  GvcpProbe& operator=(const GvcpProbe&) = delete;

  enum class Answer {
    kNone,          ///< no answer so far
    kAbsent,        ///< the host at that address reports that nothing listens there
    kFree,          ///< the camera answers, and no program controls it
    kControlled,    ///< the camera answers, and a program controls it
    kTellsNothing,  ///< the camera answers with a refusal: it is there, and busy or silent about its control
  };

  /// Interval at which an unanswered request is repeated.
  static constexpr std::chrono::milliseconds kRepeatInterval{50};

  /// Sends a new request; answers to earlier ones are ignored from then on.
  void begin() noexcept;
  /// The answer so far, without waiting; repeats the request after kRepeatInterval. begin() must come first.
  [[nodiscard]] Answer look() noexcept;
  /// A camera that answered PENDING_ACK asked to be waited for until then; in the past if none did.
  [[nodiscard]] HostTime pending_until() const noexcept { return pending_until_; }
  /// Whether the camera denies control to this program: asks for it, and gives it back if it is granted. False also if
  /// there was no answer within `patience`.
  [[nodiscard]] bool control_denied(std::chrono::milliseconds patience) noexcept;
  /// Waits for a datagram, until the next repetition of the request or `until`.
  void wait(HostTime until) const noexcept;
  /// begin(), and look() until there is an answer or `patience` is over.
  [[nodiscard]] Answer ask(std::chrono::milliseconds patience) noexcept;

 private:
  void send() noexcept;
  [[nodiscard]] std::optional<std::uint16_t> write_privilege(std::uint32_t value, HostTime deadline) noexcept;

  int fd_;
  std::uint16_t first_id_ = 1;  // of the requests that belong to the question
  std::uint16_t last_id_ = 1;
  HostTime sent_{};
  HostTime pending_until_{};
};

}  // namespace fvd
