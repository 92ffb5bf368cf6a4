#pragma once

/// What a motor controller's protocol must give for axis_controller to make an Axis of it: state, position, move, stop,
/// home.

#include <chrono>
#include <cstdint>
#include <optional>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "core/hw/axis.hpp"
#include "drivers/common/position_log.hpp"

namespace fvd {

/// How a command to the controller ended.
enum class CommandOutcome {
  kDone,
  kRefused,  ///< the controller said no: surely not executed
  kUnknown,  ///< no usable answer: may or may not have been executed
};

struct CommandResult {
  CommandOutcome outcome = CommandOutcome::kDone;
  std::string error;        ///< empty if kDone
  bool later = false;       ///< of kUnknown: the controller was busy; the line is sound
  bool repeatable = false;  ///< of kUnknown: what was not answered does no harm twice; resume() is right without a look
};

/// What is known of the controller and its axis once the port is open.
struct AxisTraits {
  std::string name;          ///< of the drive
  std::string address;       ///< of the line, e.g. "127.0.0.1:502 unit 1"
  std::string doubt_hint{};  ///< said with a position that cannot be: what may be wrong beside line and encoder
  FeedbackSource feedback = FeedbackSource::kNone;
  double steps_per_um = 1.0;                                    ///< of targets; negative where steps fall as z grows
  Micrometers feedback_resolution;                              ///< smallest step of the measured position
  Micrometers lead{};                                           ///< of the screw; 0 = unknown
  std::optional<std::pair<Micrometers, Micrometers>> limits{};  ///< the controller's own, lower and upper
  bool tells_homed = true;                                      ///< false: AxisSample::homed means nothing
  std::chrono::milliseconds start_within{150};                  ///< a move that has not begun by then was refused
  std::chrono::milliseconds home_timeout{60000};
  std::chrono::milliseconds sample_timeout{10000};  ///< longest time between two samples on a line that is alive
};

/// Something stands in the controller that fvd did not write.
struct ForeignWrite {
  std::string what;
  bool is_restart = false;  ///< it may have forgotten everything, the reference too
};

/// Speed and acceleration of a motion, both > 0.
struct MotionLimits {
  double speed_um_per_s = 0.0;
  double acceleration_um_per_s2 = 0.0;
};

/// An open, identified controller. context: thread-safe; calls block for their own exchange with the controller.
class AxisPort {
 public:
  virtual ~AxisPort() = default;

  /// Constant while the port lives. Throws nothing.
  [[nodiscard]] virtual const AxisTraits& traits() const = 0;

  /// State and position now; nothing, and why, when the controller does not answer.
  [[nodiscard]] virtual std::optional<AxisSample> sample(std::string& error) = 0;

  /// What the controller says otherwise than it must, read without moving or writing anything; asked before the first
  /// motion. Throws Error kStageDisconnected, kAborted.
  [[nodiscard]] virtual std::vector<std::string> disagreements(std::stop_token /*stop*/) { return {}; }

  /// Settings, before the first motion and whenever the axis has to be enabled; torque stays as it is. The axis rests.
  [[nodiscard]] virtual CommandResult prepare(const MotionLimits& /*limits*/, std::stop_token /*stop*/) { return {}; }

  /// Torque on; not asked for where it is on. The axis rests.
  [[nodiscard]] virtual CommandResult enable(const MotionLimits& limits, std::stop_token stop) = 0;

  /// Tells the controller to end its alarm, which it does where the cause is gone; the samples tell. Moves nothing.
  [[nodiscard]] virtual CommandResult reset_alarm(std::stop_token /*stop*/) {
    return {.outcome = CommandOutcome::kRefused, .error = "it has no command for that"};
  }

  /// Starts the search for the reference. May return before it has ended; the samples tell.
  [[nodiscard]] virtual CommandResult home(const MotionLimits& limits, std::stop_token stop) = 0;

  /// Starts an absolute move; not repeated by the port where that could start a second motion.
  [[nodiscard]] virtual CommandResult move(StageCounts target, const MotionLimits& limits, std::stop_token stop) = 0;

  /// The rest of a move or a homing that had no usable answer: from what was not answered on, which is sent again where
  /// that does no harm, and left out where not. Only for an axis that obeys, or after a `repeatable` result.
  [[nodiscard]] virtual CommandResult resume(std::stop_token /*stop*/) { return {}; }

  /// Halts the axis ahead of all else that waits for the line; sent once.
  [[nodiscard]] virtual CommandResult stop() = 0;

  /// What another master wrote since the last look; each time it is told once. Nothing where that cannot be seen. A
  /// stop request ends the patience with a busy controller, here and below.
  [[nodiscard]] virtual std::optional<ForeignWrite> foreign_write(std::stop_token /*stop*/) { return std::nullopt; }

  /// The target of the last move as the controller remembers it, steps; for controllers that do not tell whether they
  /// are homed. Nothing if it cannot be read.
  [[nodiscard]] virtual std::optional<std::int64_t> remembered_target(std::stop_token /*stop*/) { return std::nullopt; }

  /// "alarm 0x30: overload".
  [[nodiscard]] virtual std::string alarm_text(int code) const = 0;

  [[nodiscard]] virtual std::vector<StageTemperature> temperatures() { return {}; }

  /// Communication statistics, but for `implausible`.
  [[nodiscard]] virtual std::optional<StageLinkStats> link_stats() const { return std::nullopt; }
};

}  // namespace fvd
