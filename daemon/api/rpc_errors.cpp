#include "daemon/api/rpc_errors.hpp"

namespace fvd {

RpcError rpc_error(ErrorCode code) noexcept {
  switch (code) {
    case ErrorCode::kInternal:
      return {json_rpc::kInternalError, false};
    case ErrorCode::kNotReady:
      return {1001, true};
    case ErrorCode::kBusy:
      return {1002, true};
    case ErrorCode::kUnknownRecipe:
      return {1005, false};
    case ErrorCode::kBadRecipe:
      return {1006, false};
    case ErrorCode::kUnknownJob:
      return {1007, false};
    case ErrorCode::kJobFailed:
      return {1008, false};
    case ErrorCode::kSeqConflict:
      return {1009, false};
    case ErrorCode::kSeqStale:
      return {1010, false};
    case ErrorCode::kTimeout:
      return {1011, true};
    case ErrorCode::kAborted:
      return {1012, false};
    case ErrorCode::kShuttingDown:
      return {1013, true};
    case ErrorCode::kInterrupted:
      return {1014, false};
    case ErrorCode::kBadConfig:
      return {1015, false};
    case ErrorCode::kBadInput:
      return {1016, false};
    case ErrorCode::kRecipeConflict:
      return {1017, false};
    case ErrorCode::kCameraDisconnected:
      return {1101, true};
    case ErrorCode::kCameraFramesLost:
      return {1102, true};
    case ErrorCode::kCameraTimeout:
      return {1103, true};
    case ErrorCode::kCameraSettings:
      return {1104, false};
    case ErrorCode::kStageDisconnected:
      return {1111, true};
    case ErrorCode::kStageLimit:
      return {1112, false};
    case ErrorCode::kStageNotHomed:
      return {1113, false};
    case ErrorCode::kStagePosition:
      return {1114, false};
    case ErrorCode::kStageAlarm:
      return {1115, false};
    case ErrorCode::kFocusRange:
      return {1121, false};
    case ErrorCode::kTooFewValid:
      return {1122, false};
    case ErrorCode::kBadSlice:
      return {1123, false};
    case ErrorCode::kSliceLost:
      return {1124, true};
    case ErrorCode::kStorageFull:
      return {1131, false};
    case ErrorCode::kStorageWrite:
      return {1132, false};
    case ErrorCode::kDatabase:
      return {1133, false};
    case ErrorCode::kSurfaceFile:
      return {1144, false};
    case ErrorCode::kRegionOutside:
      return {1142, false};
    case ErrorCode::kCalibrationMissing:
      return {1143, false};
    case ErrorCode::kObjectiveMismatch:
      return {1146, false};
    case ErrorCode::kStudyRefused:
      return {1147, false};
    case ErrorCode::kMemoryBudget:
      return {1203, false};
  }
  return {json_rpc::kInternalError, false};
}

}  // namespace fvd
