#pragma once

/// From how far before its slices a step scan may come: below them, above them in a scan downwards.

#include <algorithm>

#include "core/scan/scan_plan.hpp"

namespace fvd {

/// The take-up before the first slice, and at least a step where a slice whose line trigger failed is approached anew:
/// only another arrival makes another edge. context: pure.
[[nodiscard]] inline Micrometers approach(const ScanPlan& plan, const StageInfo& stage) {
  const bool again = plan.line_trigger && plan.frame_retries > 0;
  return again ? std::max(stage.take_up, plan.step) : stage.take_up;
}

}  // namespace fvd
