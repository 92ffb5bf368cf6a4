#pragma once

/// The lag between the clocks of stage and camera, from one surface scanned up and down at the same speed.

#include "core/focus/fit/height_map.hpp"

namespace fvd {

struct LagResult {
  /// To be added to an exposure time before the stage's position at that time is requested: ScanPlan::time_offset.
  double lag_us = 0.0;
  double sd_us = 0.0;  ///< standard error of lag_us, from the scatter over the points
  int points = 0;      ///< points that are valid in both maps
};

/// Both scans were made with time_offset 0. A stage whose samples are late by L then reports z - v L on the way up and
/// z + v L on the way down: the median difference of the two maps is 2 v L for any surface. speed_um_per_s: v, > 0.
/// Throws Error kBadInput for maps of different shapes, kTooFewValid if fewer than 100 points are valid in both.
/// context: pure.
[[nodiscard]] LagResult measure_lag(const HeightMap& upwards, const HeightMap& downwards, double speed_um_per_s);

}  // namespace fvd
