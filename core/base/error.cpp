#include "core/base/error.hpp"

#include <array>
#include <cstddef>

namespace fvd {

namespace {

struct NamedCode {
  ErrorCode code;
  std::string_view name;
};

using enum ErrorCode;
constexpr std::array kNames{
    NamedCode{kInternal, "internal"},
    NamedCode{kBadInput, "bad_input"},
    NamedCode{kBadConfig, "bad_config"},
    NamedCode{kBadRecipe, "recipe_invalid"},
    NamedCode{kUnknownRecipe, "unknown_recipe"},
    NamedCode{kUnknownJob, "unknown_job"},
    NamedCode{kNotReady, "not_ready"},
    NamedCode{kBusy, "busy"},
    NamedCode{kSeqConflict, "seq_conflict"},
    NamedCode{kSeqStale, "seq_stale"},
    NamedCode{kJobFailed, "job_failed"},
    NamedCode{kTimeout, "timeout"},
    NamedCode{kAborted, "aborted"},
    NamedCode{kInterrupted, "interrupted"},
    NamedCode{kShuttingDown, "shutting_down"},
    NamedCode{kCameraDisconnected, "camera_disconnected"},
    NamedCode{kCameraFramesLost, "camera_frames_lost"},
    NamedCode{kCameraNoFrames, "camera_no_frames"},
    NamedCode{kCameraTimeout, "camera_timeout"},
    NamedCode{kCameraSettings, "camera_settings"},
    NamedCode{kStageDisconnected, "stage_disconnected"},
    NamedCode{kStageLimit, "stage_limit"},
    NamedCode{kStageNotHomed, "stage_not_homed"},
    NamedCode{kStagePosition, "stage_position"},
    NamedCode{kStageAlarm, "stage_alarm"},
    NamedCode{kStageTaken, "stage_taken"},
    NamedCode{kBadSlice, "bad_slice"},
    NamedCode{kSliceLost, "slice_lost"},
    NamedCode{kFocusRange, "focus_range_insufficient"},
    NamedCode{kTooFewValid, "too_few_valid_points"},
    NamedCode{kMemoryBudget, "memory_budget"},
    NamedCode{kStorageFull, "storage_full"},
    NamedCode{kStorageWrite, "storage_write_failed"},
    NamedCode{kDatabase, "db_failed"},
    NamedCode{kRecipeConflict, "recipe_conflict"},
    NamedCode{kSurfaceFile, "surface_file"},
    NamedCode{kRegionOutside, "region_outside"},
    NamedCode{kCalibrationMissing, "calibration_missing"},
    NamedCode{kObjectiveMismatch, "objective_mismatch"},
    NamedCode{kStudyRefused, "study_refused"},
    NamedCode{kResultRemoved, "result_removed"},
};
static_assert(kNames.size() == static_cast<std::size_t>(kLastErrorCode) + 1);

}  // namespace

std::string_view error_name(ErrorCode code) noexcept {
  for (const NamedCode& known : kNames) {
    if (known.code == code) return known.name;
  }
  return "internal";
}

ErrorCode error_from_name(std::string_view name) noexcept {
  for (const NamedCode& known : kNames) {
    if (known.name == name) return known.code;
  }
  return ErrorCode::kInternal;
}

}  // namespace fvd
