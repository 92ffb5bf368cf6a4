#include "daemon/api/rpc_errors.hpp"

#include <array>
#include <cstddef>

namespace fvd {

namespace {

struct CodeOnWire {
  ErrorCode code;
  RpcError error;
};

using enum ErrorCode;
constexpr std::array kCodes{
    CodeOnWire{kInternal, {json_rpc::kInternalError, false}},
    CodeOnWire{kNotReady, {1001, true}},
    CodeOnWire{kBusy, {1002, true}},
    CodeOnWire{kUnknownRecipe, {1005, false}},
    CodeOnWire{kBadRecipe, {1006, false}},
    CodeOnWire{kUnknownJob, {1007, false}},
    CodeOnWire{kJobFailed, {1008, false}},
    CodeOnWire{kSeqConflict, {1009, false}},
    CodeOnWire{kSeqStale, {1010, false}},
    CodeOnWire{kTimeout, {1011, true}},
    CodeOnWire{kAborted, {1012, false}},
    CodeOnWire{kShuttingDown, {1013, true}},
    CodeOnWire{kInterrupted, {1014, false}},
    CodeOnWire{kBadConfig, {1015, false}},
    CodeOnWire{kBadInput, {1016, false}},
    CodeOnWire{kRecipeConflict, {1017, false}},
    CodeOnWire{kResultRemoved, {1018, false}},
    CodeOnWire{kCameraDisconnected, {1101, true}},
    CodeOnWire{kCameraFramesLost, {1102, true}},
    CodeOnWire{kCameraTimeout, {1103, true}},
    CodeOnWire{kCameraSettings, {1104, false}},
    CodeOnWire{kCameraNoFrames, {1105, true}},
    CodeOnWire{kStageDisconnected, {1111, true}},
    CodeOnWire{kStageLimit, {1112, false}},
    CodeOnWire{kStageNotHomed, {1113, false}},
    CodeOnWire{kStagePosition, {1114, false}},
    CodeOnWire{kStageAlarm, {1115, false}},
    CodeOnWire{kStageTaken, {1116, false}},
    CodeOnWire{kFocusRange, {1121, false}},
    CodeOnWire{kTooFewValid, {1122, false}},
    CodeOnWire{kBadSlice, {1123, false}},
    CodeOnWire{kSliceLost, {1124, true}},
    CodeOnWire{kStorageFull, {1131, false}},
    CodeOnWire{kStorageWrite, {1132, false}},
    CodeOnWire{kDatabase, {1133, false}},
    CodeOnWire{kSurfaceFile, {1144, false}},
    CodeOnWire{kRegionOutside, {1142, false}},
    CodeOnWire{kCalibrationMissing, {1143, false}},
    CodeOnWire{kObjectiveMismatch, {1146, false}},
    CodeOnWire{kStudyRefused, {1147, false}},
    CodeOnWire{kMemoryBudget, {1203, false}},
};
static_assert(kCodes.size() == static_cast<std::size_t>(kLastErrorCode) + 1);

}  // namespace

RpcError rpc_error(ErrorCode code) noexcept {
  for (const CodeOnWire& known : kCodes) {
    if (known.code == code) return known.error;
  }
  return {json_rpc::kInternalError, false};
}

}  // namespace fvd
