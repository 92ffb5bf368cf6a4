#pragma once

/// Lateral resolution from a straight step edge.

#include <optional>
#include <string>

#include "core/metrology/height_field.hpp"
#include "core/metrology/study/noise_study.hpp"

namespace fvd::metrology {

struct EdgeResponse {
  double edge_deg = 0.0;            ///< direction of the edge in the image, from x towards y, 0 <= a < 180
  double across_deg = 0.0;          ///< direction in which is resolved, at right angles to it in um, 0 <= a < 180
  double height_um = 0.0;           ///< of the step, along z, > 0
  double width_10_90_um = 0.0;      ///< across the edge, from 10 to 90 % of the step
  std::optional<double> period_um;  ///< D_LIM: period at which the transfer is 0.5; absent where `reason` says why
  std::string reason;
  int points = 0;                ///< valid points within the reach of the edge
  double straightness_px = 0.0;  ///< root mean square of the edge's place along it, about the line
};

/// One step edge through the region, its sides flat with one common slope, at least 16 pixels long and at most a
/// quarter of the points in the transition. Heights by their distance from the fitted edge give the edge's profile;
/// its derivative's Fourier transform, over its value at 0, is the transfer (as of a slanted edge, ISO 12233:2017,
/// for heights). ISO 25178-600:2019: lateral period limit D_LIM. A box of side w reads 0.8 w and 1.657 w.
/// Refused: no two levels, no straight edge, too few points beside it. context: pure.
[[nodiscard]] StudyOutcome<EdgeResponse> edge_response(const HeightField& field, const Region& region = {});

}  // namespace fvd::metrology
