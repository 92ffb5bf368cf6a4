#pragma once

/// The Z stage as the scan needs it: absolute moves that end settled, and the position measured over an exposure.
/// Nothing here depends on a fieldbus: high-end stages speak other protocols.

#include <chrono>
#include <cstdint>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "core/base/clock.hpp"
#include "core/base/units.hpp"

namespace fvd {

/// Where the measured position comes from. kNone: step counting, the accuracy is not observable.
enum class FeedbackSource { kNone, kMotorEncoder, kLinearScale };

struct StageInfo {
  std::string name;     ///< the drive profile's name, and by what numbers this one is known
  std::string address;  ///< e.g. "127.0.0.1:502 unit 1"
  FeedbackSource feedback = FeedbackSource::kNone;
  Micrometers step_quantum;             ///< smallest commandable step
  Micrometers feedback_resolution;      ///< smallest step of the measured position
  Micrometers min;                      ///< lowest target allowed, take-up included
  Micrometers max;                      ///< highest target allowed
  Micrometers take_up;                  ///< overshoot below the first target that loads the backlash
  Micrometers lead{};                   ///< lead of the screw, which is the period of its error; 0 = unknown
  double speed_um_per_s = 0.0;          ///< speed of moves, and the highest speed of a sweep
  double acceleration_um_per_s2 = 0.0;  ///< acceleration of moves and sweeps
  bool simulated = false;
};

/// Where an axis stands between being found and being ready.
enum class AxisState {
  kDisconnected,
  kIdentifying,  ///< connected, is it the right drive?
  kDisabled,
  kNotHomed,
  kHoming,
  kReady,
  kMoving,
  kSettling,  ///< the drive has stopped, the settle criterion is not met yet
  kAlarm,
  kCommLost,  ///< the drive stopped answering; the position is unknown until the axis is opened anew
};
/// The state's name in logs and messages: "NotHomed" for kNotHomed.
[[nodiscard]] const char* axis_state_name(AxisState state) noexcept;

struct StageTemperature {
  std::string name;  ///< "driver", "motor"
  double celsius = 0.0;
};

/// Communication statistics of the line to the drive, since the axis was opened.
struct StageLinkStats {
  std::uint64_t requests = 0;
  std::uint64_t retries = 0;
  std::uint64_t unanswered = 0;  ///< requests without an answer that could be used
  std::uint64_t refused = 0;     ///< requests that the drive refused
  std::uint64_t reconnects = 0;
  std::uint64_t discarded_bytes = 0;  ///< bytes of late or garbled answers
  std::uint64_t implausible = 0;      ///< positions that no axis could have reached, and that were read again
  std::uint64_t put_off = 0;          ///< requests that the drive, or a gateway before it, was too busy for
  double latency_p50_us = 0.0;        ///< request to answer: median, 99th percentile, maximum
  double latency_p99_us = 0.0;
  double latency_max_us = 0.0;
};

struct StageStatus {
  AxisState state = AxisState::kReady;
  bool enabled = false;
  bool homed = false;
  bool moving = false;
  bool in_position = false;
  bool alarm = false;
  int alarm_code = 0;
  std::string alarm_text;
  bool lost_torque = false;  ///< disabled, and not by fvd: it may have been moved since, and is not homed
  Micrometers position;      ///< measured
  HostTime sampled{};        ///< when; of an axis that is sampled all the time
  std::vector<StageTemperature> temperatures;
};

/// Definition of "arrived": |measured - target| <= window, not moving and in position, for `samples` consecutive
/// samples that span at least `dwell`.
struct SettleCriterion {
  Micrometers window{0.5};
  int samples = 3;
  std::chrono::milliseconds dwell{15};
  std::chrono::milliseconds timeout{3000};  ///< from the start of the move
};

/// Targets, times and end position of one move.
struct MoveRecord {
  Micrometers target;            ///< as asked for
  Micrometers target_quantised;  ///< as the drive can represent it
  StageCounts target_counts;
  Micrometers position;  ///< measured, last sample of the settle criterion
  HostTime started{};
  HostTime halted{};   ///< first sample after the commanded motion had ended
  HostTime settled{};  ///< last sample of the settle criterion
  int polls = 0;       ///< queries of the drive from start to settled
};

/// Mean of the measured positions inside a time window.
struct PositionMean {
  Micrometers mean;
  Micrometers sd;   ///< sample standard deviation; 0 with fewer than two samples
  int samples = 0;  ///< samples inside the window; 0 = interpolated from the nearest before and after it
};

/// A connected axis. Constructing one connects and identifies the drive (throws Error kStageDisconnected).
/// context: one thread at a time, except stop(), connected(), last_seen(), mean_position() and position_at().
class Axis {
 public:
  virtual ~Axis() = default;

  [[nodiscard]] virtual StageInfo info() const = 0;

  /// Throws Error kStageDisconnected.
  [[nodiscard]] virtual StageStatus status() = 0;

  /// What the axis said last, however long ago: it is not asked. Nothing where nobody samples it all the time.
  /// context: any thread.
  [[nodiscard]] virtual std::optional<StageStatus> last_seen() const { return std::nullopt; }

  /// Tells the drive to end its alarm, and returns when it has: it does where the cause is gone. Nothing moves. No
  /// effect without an alarm. Throws Error kStageAlarm (it stands), kStageDisconnected, kAborted.
  virtual void reset_alarm(std::stop_token /*stop*/) {}

  /// Enables the drive and finds the reference; returns when homed and at rest.
  /// Throws Error kStageDisconnected, kStageAlarm, kTimeout, kAborted.
  virtual void home(std::stop_token stop) = 0;

  /// Moves to an absolute position and returns when settled. A stop request halts the axis.
  /// Throws Error kStageLimit (nothing moved), kStageNotHomed, kStageAlarm, kStagePosition (not settled in time),
  /// kStageDisconnected, kAborted.
  virtual MoveRecord move_to(Micrometers target, const SettleCriterion& criterion, std::stop_token stop) = 0;

  /// Moves to an absolute position at the given speed, so that positions may be taken on the way; returns when at rest.
  /// speed_um_per_s: above 0, at most StageInfo::speed_um_per_s, else Error kStageLimit. Throws as move_to() does.
  virtual MoveRecord sweep_to(Micrometers target, double speed_um_per_s, std::stop_token stop) = 0;

  /// The measured position over [from, to]; waits at most for one sample at or after `to`.
  /// Throws Error kStageDisconnected.
  [[nodiscard]] virtual PositionMean mean_position(HostTime from, HostTime to) = 0;

  /// The measured position of a moving axis: the value at `at` of a line through the samples from `at` - reach to
  /// `at` + reach. `sd` is the standard deviation of these samples about the line, `samples` their number; 0 = none
  /// lies there, the position is extrapolated. Waits at most for one sample at or after at + reach. Throws Error
  /// kStageDisconnected.
  [[nodiscard]] virtual PositionMean position_at(HostTime at, std::chrono::microseconds reach) = 0;

  /// Halts the axis ahead of everything else that is queued. context: any thread.
  virtual void stop() noexcept = 0;

  [[nodiscard]] virtual bool connected() const noexcept = 0;

  /// Nothing for an axis without a communication line (replay, fakes).
  [[nodiscard]] virtual std::optional<StageLinkStats> link_stats() const { return std::nullopt; }
};

}  // namespace fvd
