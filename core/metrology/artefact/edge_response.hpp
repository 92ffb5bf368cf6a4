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

/// One step edge through the region, at least 24 pixels long, its sides flat with one common slope. Heights by their
/// distance from the fitted edge give the edge's profile; its derivative's Fourier transform, over its value at 0, is
/// the transfer (as of a slanted edge, ISO 12233:2017, for heights). D_LIM: ISO 25178-600:2019, lateral period limit. A
/// box of side w reads 0.8 w and 1.657 w; along the pixels, which then sample it coarsely, to 1.5 %, else to 0.5 %.
/// Refused: no two levels, an edge that strays from a line by more than 1.5 pixels and 0.15 of its width, too few
/// points beside it. context: pure.
[[nodiscard]] StudyOutcome<EdgeResponse> edge_response(const HeightField& field, const Region& region = {});

}  // namespace fvd::metrology
