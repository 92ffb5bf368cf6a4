#include "daemon/api/methods/device_task.hpp"

#include "daemon/api/replies.hpp"
#include "daemon/api/rpc_errors.hpp"

namespace fvd {

namespace {

/// A command that takes longer is given up by the API; the devices have timeouts of their own.
constexpr std::chrono::minutes kLongestTask{5};

}  // namespace

void ImageParams::describe(Fields& fields) {
  fields.optional("recipe", recipe, [](Fields& inner, std::string& value) {
    inner.text("recipe", value, kMaxForeignText_bytes, "whose camera settings to use; absent = the defaults");
  });
  fields.optional("exposure_us", exposure_us, [](Fields& inner, double& value) {
    inner.number("exposure_us", value, {1e-3, 6e7}, "in place of the recipe's");
  });
  fields.optional("gain_db", gain_db, [](Fields& inner, double& value) {
    inner.number("gain_db", value, {0.0, 100.0}, "in place of the recipe's");
  });
}

CameraSettings ImageParams::settings(const RecipeService& recipes) const {
  CameraSettings camera;
  if (recipe) camera = recipes.load(*recipe).camera;
  camera.trigger = TriggerMode::kSoftware;
  if (exposure_us) camera.exposure_us = *exposure_us;
  if (gain_db) camera.gain_db = *gain_db;
  return camera;
}

Deferred reply_when_done(std::shared_ptr<DeviceTask> task) { return {std::move(task), kLongestTask}; }

void require_wait(const Call& call) {
  if (call.may_wait) return;
  throw ProtocolError{json_rpc::kInvalidRequest, call.method + " takes time: not in a batch, and only with an id"};
}

MethodDescription task_description(std::string summary, Role role, DescribeFields params, DescribeFields result,
                                   std::vector<ErrorCode> further_errors, TaskMotion motion) {
  using enum ErrorCode;
  std::vector<ErrorCode> errors{kNotReady, kBusy, kTimeout, kAborted, kShuttingDown};
  errors.insert(errors.end(), further_errors.begin(), further_errors.end());
  return {.summary = std::move(summary),
          .role = role,
          .params = std::move(params),
          .result = std::move(result),
          .errors = std::move(errors),
          .moves_stage = motion == TaskMotion::kMoves,
          .may_wait = true,
          .needs_control = motion == TaskMotion::kMoves,
          .is_audited = motion == TaskMotion::kMoves,
          .needs_id = true};
}

}  // namespace fvd
