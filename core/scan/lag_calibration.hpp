#pragma once

/// How far the stage's clock is off the camera's, from one surface scanned up and down at the same speed.

#include "core/focus/fit/height_map.hpp"

namespace fvd {

struct LagResult {
  double lag_us =
      0.0;             ///< to be added to exposure times where the stage's position is asked for: ScanPlan::time_offset
  double sd_us = 0.0;  ///< standard error of that, from the scatter over the points
  int points = 0;      ///< valid in both maps
};

/// With positions that are taken at exposure + 0, a stage whose samples are late by L tells z - v L on the way up and
/// z + v L on the way down: the median difference of the two maps is 2 v L, whatever the surface.
/// speed_um_per_s > 0. Throws Error kBadInput for maps of different shapes, kTooFewValid for fewer than 100 points.
[[nodiscard]] LagResult measure_lag(const HeightMap& upwards, const HeightMap& downwards, double speed_um_per_s);

}  // namespace fvd
