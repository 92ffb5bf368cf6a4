#pragma once

/// Commands to the devices: methods whose reply comes when a task is done.

#include <memory>

#include "daemon/api/method.hpp"
#include "daemon/jobs/services.hpp"

namespace fvd {

/// The camera's settings for an image between the jobs.
struct ImageParams {
  std::optional<std::string> recipe;
  std::optional<double> exposure_us;
  std::optional<double> gain_db;

  void describe(Fields& fields);
  /// By a software trigger. Throws Error kUnknownRecipe, kBadRecipe.
  [[nodiscard]] CameraSettings settings(const RecipeService& recipes) const;
};

/// The reply to a call that began the task. context: any thread.
[[nodiscard]] Deferred reply_when_done(std::shared_ptr<DeviceTask> task);
/// Throws ProtocolError if the reply could not come later; called before the task is begun.
void require_wait(const Call& call);

/// The description of such a method: it needs an id and may wait. motion: kMoves = it moves the stage.
[[nodiscard]] MethodDescription task_description(std::string summary, Role role, DescribeFields params,
                                                 DescribeFields result, std::vector<ErrorCode> further_errors,
                                                 TaskMotion motion);

}  // namespace fvd
