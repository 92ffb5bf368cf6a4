#pragma once

/// Faults of line and drive in the order in which they are to happen.

#include <chrono>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/mutex.hpp"

namespace fvd::sim {

enum class FaultOn { kRead, kWrite, kAny };

enum class FaultKind {
  kLateReply,        ///< executed; the reply leaves `delay` late
  kLostReply,        ///< executed, not answered
  kLostRequest,      ///< not executed, not answered
  kWrongCrc,         ///< executed; serial: wrong checksum; TCP: the reply carries another transaction's number
  kTruncatedFrame,   ///< executed; half of the reply and then nothing, the line stays
  kException,        ///< not executed; exception `code`
  kSilentRefusal,    ///< acknowledged, but the drive ignores the next start of a motion
  kLinkCut,          ///< not executed; TCP: all connections closed; both: everything ignored for `delay`
  kStaleInPosition,  ///< the drive reports standstill in position for `delay` from this request on
  kAlarmInMotion,    ///< alarm `code`, at the first matching request that comes while the axis moves
  kLimitHit,         ///< a limit switch, before the request is executed
  kEmergencyStop,    ///< torque off, before the request is executed
  kPowerCycle,       ///< the drive restarts: not executed; as kLinkCut while it boots
  kExceptionAfter,   ///< executed; exception `code` in place of the reply, as of a gateway that gave up too early
  kSwappedWords,     ///< executed; the words of the drive's 32-bit values go and come in the other order
  kSecondMaster,     ///< another master writes `words` from register `to` on, before the request is executed
};

/// The names of the faults in scripts: "late_reply" and so on.
[[nodiscard]] const std::vector<std::string>& fault_names();
[[nodiscard]] std::string_view name_of(FaultKind kind);

struct FaultStep {
  FaultOn on = FaultOn::kAny;    ///< a request that reads and writes (function code 23) counts as a write
  int after = 0;                 ///< number of matching requests that pass first, >= 0
  std::optional<int> address{};  ///< PDU address that a request must contain to match; none = any
  int count = 1;                 ///< number of times that the fault happens, > 0
  FaultKind fault = FaultKind::kLostReply;
  std::chrono::milliseconds delay{0};  ///< kLateReply, kLinkCut, kStaleInPosition, kPowerCycle
  int code = 0;                        ///< kException, kExceptionAfter 1..255, kAlarmInMotion 1..65535
  int to = 0;                          ///< kSecondMaster: PDU address
  std::vector<std::uint16_t> words{};  ///< kSecondMaster: 1..123
};

/// Steps are taken one after the other: a step waits until the one before it has happened as often as it should.
/// context: thread-safe.
class FaultScript {
 public:
  FaultScript() = default;
  /// Throws Error kBadConfig for a step that cannot happen, naming it.
  explicit FaultScript(const std::vector<FaultStep>& steps);

  /// Appends a step. Throws as the constructor.
  void add(const FaultStep& step);

  /// The fault that strikes this request PDU, if any. To be called once per request.
  [[nodiscard]] std::optional<FaultStep> next(std::span<const std::uint8_t> request, bool axis_moves);

  /// Notes that a step which was taken could not happen after all; it counts as one that did not.
  void failed(const FaultStep& step, const std::string& reason);

  /// Steps that have not happened as often as they should.
  [[nodiscard]] std::size_t unconsumed() const;
  /// One line per step that has not happened; empty if all have.
  [[nodiscard]] std::string describe_unconsumed() const;

 private:
  mutable Mutex mutex_;
  std::deque<FaultStep> steps_ FVD_GUARDED_BY(mutex_);  // after and count of the first run down
  int taken_ FVD_GUARDED_BY(mutex_) = 0;
  std::vector<std::string> failed_ FVD_GUARDED_BY(mutex_);
};

}  // namespace fvd::sim
