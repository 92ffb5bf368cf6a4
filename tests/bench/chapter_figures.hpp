#pragma once

/// Errors of a height map of the chapter's surface, region by region.

#include "core/focus/fit/height_map.hpp"
#include "sim/world/surface.hpp"
#include "tests/bench/accuracy_scans.hpp"

namespace fvd::bench {

struct ChapterFigures {
  ErrorSum plateaus;
  ErrorSum ramp;
  double textured = 0.0;    // points
  double poor_kept = 0.0;   // inside the texture-poor patch, away from its border
  double poor_wrong = 0.0;  // of these, off by more than 5 um
  double poor_points = 0.0;
};

/// um.
[[nodiscard]] ChapterFigures chapter_figures(const sim::Surface& surface, const HeightMap& map);

}  // namespace fvd::bench
