#pragma once

/// A dedicated measurement of the stage: up and down over a range, as often as asked.

#include <functional>
#include <stop_token>
#include <vector>

#include "core/base/clock.hpp"
#include "core/hw/axis.hpp"
#include "core/stage/stage_point.hpp"

namespace fvd {

struct StageRunPlan {
  Micrometers from{0.0};
  Micrometers to{0.0};  ///< above from
  int steps = 100;      ///< >= 1; steps + 1 positions
  int repeats = 3;      ///< >= 1; each up and down
  SettleCriterion settle;
  std::chrono::milliseconds average{20};  ///< time after settling over which the measured position is averaged
};

/// Each pass starts with a move beyond its first position by the stage's take-up distance, so that every position of an
/// upward pass is approached from below and of a downward one from above. on_point: called after each point with the
/// number of points so far and of all. Throws Error kBadInput for a plan out of its ranges, kStageLimit before anything
/// moves if the take-up does not fit, and as Axis::move_to(). The stage must be homed. context: blocks.
[[nodiscard]] std::vector<StagePoint> run_stage(Axis& stage, Clock& clock, const StageRunPlan& plan,
                                                const std::function<void(int done, int all)>& on_point,
                                                std::stop_token stop);

}  // namespace fvd
