#pragma once

/// The one exception of the program and its codes. The symbolic name of a code is the stable contract on the wire.

#include <stdexcept>
#include <string>
#include <string_view>

namespace fvd {

enum class ErrorCode {
  kInternal,   ///< a bug, or an exception that was not translated
  kBadInput,   ///< a file or argument the user gave cannot be used
  kBadConfig,  ///< the configuration was refused
  kBadRecipe,  ///< the recipe was refused
  kUnknownRecipe,
  kUnknownJob,
  kNotReady,     ///< the machine is in a state that does not take jobs
  kBusy,         ///< another job or command is running; may succeed later
  kSeqConflict,  ///< same sequence number, different request
  kSeqStale,     ///< sequence number older than the window that is remembered
  kJobFailed,    ///< reserved, never raised: a job tells its own error
  kTimeout,
  kAborted,
  kInterrupted,  ///< the daemon stopped or died while the job ran
  kShuttingDown,
  kCameraDisconnected,  ///< no reply from the camera, control lost, or not open
  kCameraFramesLost,    ///< no good frame within the retries, for more slices than the recipe allows
  kCameraNoFrames,      ///< the camera answers and takes triggers, but delivers nothing at all
  kCameraTimeout,       ///< reserved, never raised: kCameraFramesLost
  kCameraSettings,      ///< the camera refused a setting or reads back another value
  kStageDisconnected,   ///< no reply from the drive, or the link is gone
  kStageLimit,          ///< a target outside the configured or the drive's limits
  kStageNotHomed,
  kStagePosition,  ///< the axis did not settle at its target
  kStageAlarm,     ///< the drive raised an alarm
  kStageTaken,     ///< another program or another master has the drive
  kBadSlice,       ///< slice of another size, format or with an unusable z
  kSliceLost,      ///< the slice queue refused a slice: computation fell behind
  kFocusRange,     ///< the surface is not inside the scanned range
  kTooFewValid,    ///< fewer valid points than the recipe asks for
  kMemoryBudget,   ///< the job would need more memory than it may use
  kStorageFull,
  kStorageWrite,
  kDatabase,
  kRecipeConflict,      ///< the recipe was changed meanwhile
  kSurfaceFile,         ///< a file that is to hold a surface cannot be read as one
  kRegionOutside,       ///< what an evaluation looks at does not lie in the field of view
  kCalibrationMissing,  ///< an evaluation or a study needs constants that there are none of
  kObjectiveMismatch,   ///< the recipe's objective is not the one that was confirmed
  kStudyRefused,        ///< the jobs of a study do not make one
  kResultRemoved,       ///< the job's result was removed to make room; the last: see kLastErrorCode
};
inline constexpr ErrorCode kLastErrorCode = ErrorCode::kResultRemoved;

/// The stable name of a code, e.g. "camera_disconnected".
[[nodiscard]] std::string_view error_name(ErrorCode code) noexcept;
/// The code that has this name; kInternal for a name that no code has.
[[nodiscard]] ErrorCode error_from_name(std::string_view name) noexcept;

/// what() says what failed, where, and what to do. A caller that knows more catches it and throws one that says more.
class Error : public std::runtime_error {
 public:
  Error(ErrorCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
  [[nodiscard]] ErrorCode code() const noexcept { return code_; }

 private:
  ErrorCode code_;
};

}  // namespace fvd
