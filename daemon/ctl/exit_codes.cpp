#include "daemon/ctl/exit_codes.hpp"

namespace fvd::ctl {

int exit_code(ErrorCode code) noexcept {
  switch (code) {
    case ErrorCode::kBadInput:
    case ErrorCode::kBadConfig:
    case ErrorCode::kBadRecipe:
    case ErrorCode::kUnknownRecipe:
    case ErrorCode::kRecipeConflict:
    case ErrorCode::kUnknownJob:
    case ErrorCode::kResultRemoved:
    case ErrorCode::kBadSlice:
    case ErrorCode::kMemoryBudget:
    case ErrorCode::kStageLimit:
    case ErrorCode::kSurfaceFile:
    case ErrorCode::kRegionOutside:
    case ErrorCode::kCalibrationMissing:
    case ErrorCode::kObjectiveMismatch:
    case ErrorCode::kStudyRefused:
      return kExitBadData;
    case ErrorCode::kStorageFull:
    case ErrorCode::kStorageWrite:
    case ErrorCode::kDatabase:
      return kExitIo;
    case ErrorCode::kNotReady:
    case ErrorCode::kBusy:
    case ErrorCode::kTimeout:
    case ErrorCode::kShuttingDown:
    case ErrorCode::kCameraDisconnected:
    case ErrorCode::kStageDisconnected:
    case ErrorCode::kStageNotHomed:
    case ErrorCode::kStagePosition:
    case ErrorCode::kStageAlarm:
    case ErrorCode::kStageTaken:
      return kExitUnavailable;
    case ErrorCode::kAborted:
    case ErrorCode::kJobFailed:
    case ErrorCode::kCameraSettings:
    case ErrorCode::kCameraFramesLost:
    case ErrorCode::kCameraNoFrames:
    case ErrorCode::kFocusRange:
      return kExitJobFailed;
    default:
      return kExitInternal;
  }
}

int exit_code_of_rpc(int code) noexcept {
  switch (code) {
    case -32600:  // invalid request
    case -32601:  // unknown method
    case -32602:  // invalid parameters
    case 1004:    // not allowed
    case 1005:    // unknown recipe
    case 1006:    // invalid recipe
    case 1007:    // unknown job
    case 1009:    // sequence number taken by another request
    case 1010:    // sequence number too old
    case 1015:    // invalid configuration
    case 1016:    // invalid input
    case 1017:    // recipe changed meanwhile
    case 1018:    // result removed
    case 1142:    // region outside
    case 1143:    // calibration missing
    case 1144:    // file of a surface
    case 1146:    // another objective
    case 1147:    // study refused
    case 1203:    // too large
      return kExitBadData;
    case 1001:  // not ready
    case 1002:  // busy
    case 1003:  // another has control
    case 1011:  // timeout
    case 1013:  // shutting down
      return kExitUnavailable;
    case 1131:  // storage full
    case 1132:  // storage write failed
    case 1133:  // database failed
      return kExitIo;
    default:
      break;
  }
  return code >= 1000 ? kExitJobFailed : kExitInternal;
}

}  // namespace fvd::ctl
