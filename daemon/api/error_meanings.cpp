#include "daemon/api/error_meanings.hpp"

#include <array>

#include "daemon/result/evaluation_result.hpp"

namespace fvd {

namespace {

struct ResultCode {
  int code;
  std::string_view name;
  std::string_view meaning;
};

constexpr std::array kResultCodes{
    ResultCode{evaluation_code::kTooFewValid, "too_few_valid_points",
               "a region has fewer valid points than min_valid_fraction: more light, or less of it, or another region"},
    ResultCode{evaluation_code::kInvalid, "evaluation_invalid",
               "a measurement could not be made, and none of its limits counts as kept: its reason says why"},
    ResultCode{evaluation_code::kRegionOutside, "region_outside",
               "what a measurement looks at does not lie in the field of view: move the region, or the part"},
    ResultCode{
        evaluation_code::kUncertain, "verdict_uncertain",
        "information: U lets neither pass nor fail be stated: measure again with less noise, or widen the limit"},
};

std::string_view request_meaning(ErrorCode code) noexcept {
  switch (code) {
    case ErrorCode::kInternal:
      return "a bug: keep the log and tell who maintains fvd";
    case ErrorCode::kBadInput:
      return "a file or parameter cannot be used: the message says which";
    case ErrorCode::kBadConfig:
      return "the configuration was refused: correct the places that the message names";
    case ErrorCode::kBadRecipe:
      return "the recipe was refused: correct the places that the message names";
    case ErrorCode::kUnknownRecipe:
      return "there is no such recipe: recipe.list tells those that are known";
    case ErrorCode::kUnknownJob:
      return "there is no such job, or result: job.latest tells the newest";
    case ErrorCode::kNotReady:
      return "the machine takes no jobs in this state: wait for `ready`";
    case ErrorCode::kBusy:
      return "something else runs: ask again when it is done";
    case ErrorCode::kSeqConflict:
      return "the number belongs to another request: use a new one";
    case ErrorCode::kSeqStale:
      return "the number is too far behind or ahead, or its job ended too long ago to be repeated: continue behind "
             "newest_seq";
    case ErrorCode::kJobFailed:
      return "reserved: a job tells its own error";
    case ErrorCode::kTimeout:
      return "no answer in time: look at the state, then ask again";
    case ErrorCode::kAborted:
      return "somebody aborted it";
    case ErrorCode::kInterrupted:
      return "the daemon stopped meanwhile: measure the part again with a new number";
    case ErrorCode::kShuttingDown:
      return "the daemon stops: ask again when it is back";
    case ErrorCode::kRecipeConflict:
      return "the recipe was changed meanwhile: get it anew and put the change into that";
    case ErrorCode::kResultRemoved:
      return "the result was removed to make room, as the group store says: job.status tells what the job came to";
    default:
      return {};
  }
}

std::string_view device_meaning(ErrorCode code) noexcept {
  switch (code) {
    case ErrorCode::kCameraDisconnected:
      return "the camera does not answer, or another program has it: look at cable, power and address";
    case ErrorCode::kCameraFramesLost:
      return "too many frames were lost: look at network, packet size and load";
    case ErrorCode::kCameraNoFrames:
      return "the camera answers but delivers nothing at all, and is being opened anew: look at firewall, trigger "
             "source and stream address";
    case ErrorCode::kCameraTimeout:
      return "reserved: a camera without frames is camera_frames_lost";
    case ErrorCode::kCameraSettings:
      return "the camera refused a setting of the recipe: the message names it";
    case ErrorCode::kStageDisconnected:
      return "the drive does not answer: look at cable, power and address";
    case ErrorCode::kStageLimit:
      return "the scan would leave the stage's limits: move or shorten its range";
    case ErrorCode::kStageNotHomed:
      return "the axis has no reference: call stage.home";
    case ErrorCode::kStagePosition:
      return "the axis did not settle at its target: look for what blocks it, or allow it more time";
    case ErrorCode::kStageAlarm:
      return "the drive raised an alarm: see its manual, see to the cause, then error.reset and stage.home";
    case ErrorCode::kStageTaken:
      return "another program or another master has the drive: end it, see to the part, then measure again";
    case ErrorCode::kBadSlice:
      return "a slice has another size or format than the first";
    case ErrorCode::kSliceLost:
      return "computing fell behind: a smaller region, a slower scan, or more threads";
    default:
      return {};
  }
}

std::string_view result_meaning(ErrorCode code) noexcept {
  switch (code) {
    case ErrorCode::kFocusRange:
      return "the surface lies beyond the scanned range: move or widen it";
    case ErrorCode::kTooFewValid:
      return "fewer points are valid than the recipe asks for: check light, exposure and range";
    case ErrorCode::kMemoryBudget:
      return "it needs more memory than it may use: the message has the figures";
    case ErrorCode::kStorageFull:
      return "the disk is full: make room";
    case ErrorCode::kStorageWrite:
      return "a file could not be written: look at folder, rights and disk";
    case ErrorCode::kDatabase:
      return "the database could not be read or written: the message says why";
    case ErrorCode::kSurfaceFile:
      return "a file cannot be read as a surface: the message has file, place and reason";
    case ErrorCode::kRegionOutside:
      return "the recipe looks at what does not lie in the field of view: correct the places that the message names";
    case ErrorCode::kCalibrationMissing:
      return "there are no constants that it needs: calibrate, and accept them";
    case ErrorCode::kObjectiveMismatch:
      return "the recipe's objective is not the confirmed one: change it and confirm, or take another recipe";
    case ErrorCode::kStudyRefused:
      return "the jobs do not make a study: the message says which, and what it needs";
    default:
      return {};
  }
}

}  // namespace

std::string_view error_meaning(ErrorCode code) noexcept {
  for (const auto meaning : {request_meaning(code), device_meaning(code), result_meaning(code)}) {
    if (!meaning.empty()) return meaning;
  }
  return {};
}

std::string_view error_meaning(AccessCode code) noexcept {
  return code == AccessCode::kNotAllowed ? "this caller may not do that: ask who looks after the instrument"
                                         : "somebody else has control: wait until he gives it up, or ask him";
}

std::string result_codes_markdown() {
  std::string text = "| code in `c` and `reason_code` | name | meaning, what to do |\n|---|---|---|\n";
  for (const ResultCode& row : kResultCodes) {
    text += "| " + std::to_string(row.code) + " | " + std::string(row.name) + " | " + std::string(row.meaning) + " |\n";
  }
  return text;
}

}  // namespace fvd
