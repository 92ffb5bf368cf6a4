#pragma once

/// Where the slices of a scan lie, and what may go wrong before it fails.

#include "core/hw/z_stage.hpp"
#include "core/units.hpp"

namespace fvd {

struct ScanPlan {
  Micrometers start;       ///< target of slice 0
  Micrometers step{10.0};  ///< > 0: the scan goes one way only, so that backlash stays loaded
  int slices = 0;          ///< >= 1
  SettleCriterion settle;
  int frame_retries = 3;        ///< further triggers for a slice whose frame was lost
  int allowed_lost_slices = 0;  ///< more fail the scan

  [[nodiscard]] Micrometers target(int index) const { return start + static_cast<double>(index) * step; }
  [[nodiscard]] Micrometers last() const { return target(slices - 1); }
};

/// Throws Error kStageLimit, with the values and the range, if the scan or its take-up move would leave the limits.
void check_plan(const ScanPlan& plan, const StageInfo& stage);

}  // namespace fvd
