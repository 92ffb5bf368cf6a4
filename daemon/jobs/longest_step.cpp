#include "daemon/jobs/longest_step.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "daemon/pipeline/measurement.hpp"

namespace fvd {

namespace {

using std::chrono::milliseconds;

constexpr std::chrono::minutes kLongestPhase{10};   // of computing and storing, and to open and set up the devices
constexpr std::chrono::minutes kLongestHoming{10};  // timing.home_timeout_ms allows no more
constexpr std::chrono::seconds kFrameMargin{12};    // camera.frame_margin_ms allows 10 s; and the transfer

/// Moves and frames of the slice, and before it those of the take-up.
milliseconds slice_by_step(const Recipe& recipe) {
  const std::int64_t attempts = 1 + recipe.frame_retries;
  const milliseconds frame =
      kFrameMargin + milliseconds(static_cast<std::int64_t>(std::ceil(recipe.camera.exposure_us / 1000.0)));
  const bool by_line = recipe.camera.trigger == TriggerMode::kLine;
  // By the line each attempt comes anew from afar; else a frame that is not believed is taken again with all retries.
  return 2 * recipe.settle.timeout * (by_line ? attempts : 1) + frame * (by_line ? attempts : attempts * attempts);
}

/// The stage may come to the first slice at the scan's own speed.
milliseconds sweep(const Recipe& recipe, const StageInfo& stage) {
  constexpr double kLongest_s = 7 * 86400.0;
  const ScanPlan plan = scan_plan(recipe);
  const double way_um = run_up(plan, stage).value + plan.step.value * plan.slices + run_out(plan, stage).value;
  const double sweep_s = std::min(way_um / plan.speed_um_per_s, kLongest_s);
  return recipe.settle.timeout + milliseconds(static_cast<std::int64_t>(2000.0 * sweep_s));
}

}  // namespace

milliseconds longest_step(const Recipe& recipe, const StageInfo& stage) {
  const bool sweeps = recipe.mode == ScanMode::kContinuous && recipe.speed_um_per_s > 0.0;
  return kLongestPhase + kLongestHoming + (sweeps ? sweep(recipe, stage) : slice_by_step(recipe));
}

}  // namespace fvd
