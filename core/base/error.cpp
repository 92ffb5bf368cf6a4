#include "core/base/error.hpp"

namespace fvd {

std::string_view error_name(ErrorCode code) noexcept {
  switch (code) {
    case ErrorCode::kInternal:
      return "internal";
    case ErrorCode::kBadInput:
      return "bad_input";
    case ErrorCode::kBadConfig:
      return "bad_config";
    case ErrorCode::kBadRecipe:
      return "recipe_invalid";
    case ErrorCode::kUnknownRecipe:
      return "unknown_recipe";
    case ErrorCode::kUnknownJob:
      return "unknown_job";
    case ErrorCode::kNotReady:
      return "not_ready";
    case ErrorCode::kBusy:
      return "busy";
    case ErrorCode::kSeqConflict:
      return "seq_conflict";
    case ErrorCode::kSeqStale:
      return "seq_stale";
    case ErrorCode::kJobFailed:
      return "job_failed";
    case ErrorCode::kTimeout:
      return "timeout";
    case ErrorCode::kAborted:
      return "aborted";
    case ErrorCode::kInterrupted:
      return "interrupted";
    case ErrorCode::kShuttingDown:
      return "shutting_down";
    case ErrorCode::kCameraDisconnected:
      return "camera_disconnected";
    case ErrorCode::kCameraFramesLost:
      return "camera_frames_lost";
    case ErrorCode::kCameraTimeout:
      return "camera_timeout";
    case ErrorCode::kCameraSettings:
      return "camera_settings";
    case ErrorCode::kStageDisconnected:
      return "stage_disconnected";
    case ErrorCode::kStageLimit:
      return "stage_limit";
    case ErrorCode::kStageNotHomed:
      return "stage_not_homed";
    case ErrorCode::kStagePosition:
      return "stage_position";
    case ErrorCode::kStageAlarm:
      return "stage_alarm";
    case ErrorCode::kBadSlice:
      return "bad_slice";
    case ErrorCode::kSliceLost:
      return "slice_lost";
    case ErrorCode::kFocusRange:
      return "focus_range_insufficient";
    case ErrorCode::kTooFewValid:
      return "too_few_valid_points";
    case ErrorCode::kMemoryBudget:
      return "memory_budget";
    case ErrorCode::kStorageFull:
      return "storage_full";
    case ErrorCode::kStorageWrite:
      return "storage_write_failed";
    case ErrorCode::kDatabase:
      return "db_failed";
    case ErrorCode::kRecipeConflict:
      return "recipe_conflict";
    case ErrorCode::kSurfaceFile:
      return "surface_file";
    case ErrorCode::kRegionOutside:
      return "region_outside";
    case ErrorCode::kCalibrationMissing:
      return "calibration_missing";
    case ErrorCode::kObjectiveMismatch:
      return "objective_mismatch";
    case ErrorCode::kStudyRefused:
      return "study_refused";
  }
  return "internal";
}

ErrorCode error_from_name(std::string_view name) noexcept {
  for (int code = 0; code <= static_cast<int>(kLastErrorCode); ++code) {
    if (error_name(static_cast<ErrorCode>(code)) == name) return static_cast<ErrorCode>(code);
  }
  return ErrorCode::kInternal;
}

}  // namespace fvd
