#pragma once

/// What must hold before and while an axis moves; each check throws an Error that says what to do.

#include "core/base/error.hpp"
#include "drivers/common/axis_port.hpp"

namespace fvd {

/// What the configuration says of an axis.
struct AxisSettings {
  Micrometers min;  ///< lowest target, take-up included
  Micrometers max;  ///< highest target
  Micrometers take_up;
  MotionLimits limits;  ///< of moves, and the fastest a sweep may be
  bool simulated = false;
};

/// What is said of the axis to whoever uses it.
[[nodiscard]] StageInfo stage_info(const AxisTraits& traits, const AxisSettings& settings);

/// What a sample says, without the state.
[[nodiscard]] StageStatus stage_status(const AxisPort& port, const AxisSample& sample,
                                       std::vector<StageTemperature> temperatures);
/// Where a connected axis stands. commanded: what it is told to do, kReady if nothing.
[[nodiscard]] AxisState axis_state(const AxisSample& sample, AxisState commanded);
/// The axis moves, or stands where the move leads, or no longer where it stood before it.
[[nodiscard]] bool obeys(const AxisSample& sample, const MoveRecord& move, const AxisSample& before,
                         const SettleCriterion& criterion);
/// When a sweep over such a distance has ended.
[[nodiscard]] SettleCriterion end_of_sweep(const AxisSettings& settings, Micrometers distance, double speed_um_per_s);
/// Why a move whose time is over did not end: where the axis stands, and what is missing if that is where it should.
[[nodiscard]] std::string not_settled_text(const MoveRecord& move, const AxisSample& sample,
                                           const SettleCriterion& criterion);

/// Throws Error kAborted if a stop was requested: nothing begins to move for a caller that does not want it any more.
void require_wanted(const std::stop_token& stop);
/// Throws Error kBadConfig if the controller is not what the port takes it for, with every reason, and as
/// AxisPort::disagreements() does.
void require_agreement(AxisPort& port, const std::stop_token& stop);
/// Throws Error kStageNotHomed. what: an addition, empty or with a space before it.
[[noreturn]] void throw_forgotten(const AxisTraits& traits, const std::string& what);
/// Throws Error kStageTaken, or as throw_forgotten() for a restart.
[[noreturn]] void throw_foreign(const AxisTraits& traits, const ForeignWrite& foreign);
/// The error is one that another master can bring about: an axis that he sent elsewhere or disabled, a target of his.
[[nodiscard]] bool may_be_anothers_doing(ErrorCode code);
/// Throws Error kStagePosition: the controller said yes to the move, and nothing came of it.
[[noreturn]] void throw_not_begun(const AxisTraits& traits, Micrometers target);
/// Throws Error kStageAlarm: its torque is gone, and fvd did not take it.
[[noreturn]] void throw_disabled(const AxisTraits& traits);
/// Throws Error kTimeout.
[[noreturn]] void throw_not_homed_in_time(const AxisTraits& traits);
/// Throws Error kCameraFramesLost for a time more than two seconds ahead: times of exposures are told by the camera's
/// clock, and nobody can end a wait for them.
void require_near(const AxisTraits& traits, HostTime time);
/// The traits. Throws Error kStageLimit if the configured limits reach beyond the controller's own.
const AxisTraits& require_limits_inside(const AxisTraits& traits, const AxisSettings& settings);
/// Throws Error kStageLimit if the target is beyond the controller's counter.
[[nodiscard]] StageCounts quantise(const AxisTraits& traits, Micrometers target);
/// Throws Error kStageLimit for a target outside min..max.
void require_within_limits(const AxisSettings& settings, Micrometers target);
/// Throws Error kStageLimit for a speed that is not above 0 or above that of moves.
void require_sweep_speed(const AxisSettings& settings, double speed_um_per_s);
/// Throws Error kStageAlarm for an emergency stop, and for an alarm unless the axis stands on a limit switch: that may
/// be its reference, some drives report it as an alarm, and homing leads away from it.
void require_homing_possible(const AxisPort& port, const AxisSample& sample);
/// Throws Error kStageAlarm for an alarm or an emergency stop.
void require_no_alarm(const AxisPort& port, const AxisSample& sample);
/// Throws Error kStageNotHomed before a move of an axis without a reference, and in one that lost it.
void require_homed(const AxisTraits& traits, const AxisSample& sample);
void require_reference_kept(const AxisTraits& traits, const AxisSample& sample);
/// Throws Error kStageLimit on a limit switch.
void require_off_limits(const AxisTraits& traits, const AxisSample& sample);
/// Throws Error kStagePosition (refused) or kStageDisconnected (no answer) for a command that was not done.
void require_done(const AxisTraits& traits, const CommandResult& result, const char* command);

}  // namespace fvd
