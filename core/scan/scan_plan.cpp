#include "core/scan/scan_plan.hpp"

#include <algorithm>
#include <sstream>

#include "core/base/error.hpp"
#include "core/scan/approach.hpp"

namespace fvd {

namespace {

[[noreturn]] void refuse(const std::ostringstream& message) { throw Error(ErrorCode::kBadRecipe, message.str()); }

}  // namespace

Micrometers run_out(const ScanPlan& plan, const StageInfo& stage) {
  const double speed = plan.speed_um_per_s;
  const double ramp_um = stage.acceleration_um_per_s2 > 0.0 ? speed * speed / 2.0 / stage.acceleration_um_per_s2 : 0.0;
  const double reach_s = std::chrono::duration<double>(kPositionReach).count();
  return Micrometers{ramp_um + reach_s * speed} + plan.step;
}

Micrometers run_up(const ScanPlan& plan, const StageInfo& stage) {
  return std::max(run_out(plan, stage), stage.take_up);
}

void check_continuous(const ScanPlan& plan, const CameraSettings& settings, const StageInfo& stage) {
  std::ostringstream message;
  const double exposure_s = settings.exposure_us * 1e-6;
  if (stage.feedback == FeedbackSource::kNone) {
    message << "a continuous scan needs a stage that measures its position, " << stage.name
            << " only counts steps: use scan.mode step";
    refuse(message);
  }
  if (!(plan.speed_um_per_s > 0.0) || plan.speed_um_per_s > stage.speed_um_per_s) {
    message << "acquire.scan.speed_um_per_s of " << plan.speed_um_per_s
            << " um/s must lie above 0 and at most at the stage's " << stage.speed_um_per_s << " um/s";
    refuse(message);
  }
  if (exposure_s * plan.speed_um_per_s > plan.max_blur_steps * plan.step.value) {
    message << "in an exposure of " << settings.exposure_us << " us at " << plan.speed_um_per_s
            << " um/s the stage moves " << exposure_s * plan.speed_um_per_s << " um, more than " << plan.max_blur_steps
            << " steps of " << plan.step.value << " um: at most " << plan.max_blur_steps * plan.step.value / exposure_s
            << " um/s, or a shorter exposure with more light";
    refuse(message);
  }
  if (exposure_s * plan.frame_rate_hz() >= 1.0) {
    message << "slices of " << plan.step.value << " um at " << plan.speed_um_per_s << " um/s need "
            << plan.frame_rate_hz() << " frames per second, an exposure of " << settings.exposure_us << " us allows "
            << 1.0 / exposure_s;
    refuse(message);
  }
}

void check_plan(const ScanPlan& plan, const StageInfo& stage) {
  const bool moving = plan.mode == ScanMode::kContinuous;
  const Micrometers before = moving ? run_up(plan, stage) : approach(plan, stage);
  const Micrometers behind = moving ? run_out(plan, stage) : Micrometers{0.0};
  const Micrometers lowest = plan.start - (plan.downwards ? behind : before);
  const Micrometers highest = plan.highest() + (plan.downwards ? before : behind);
  if (lowest >= stage.min && highest <= stage.max) return;
  std::ostringstream message;
  message << "the scan from " << plan.start.value << " um to " << highest.value << " um with " << before.value
          << (moving           ? " um of run-up needs "
              : plan.downwards ? " um of take-up above needs "
                               : " um of take-up below needs ")
          << lowest.value << ".." << highest.value << " um, the stage may travel " << stage.min.value << ".."
          << stage.max.value << " um: change the recipe's range or the stage's limits";
  throw Error(ErrorCode::kStageLimit, message.str());
}

}  // namespace fvd
