#pragma once

/// The two flanks of an edge as planes, and the straight line in which they meet.

#include <optional>

#include "core/metrology/edge/edge_options.hpp"
#include "core/metrology/edge/edge_result.hpp"
#include "core/metrology/height_field.hpp"

namespace fvd::metrology::edge {

/// A straight line in the image with a height. u points from the rake to the clearance, e = u turned so that (u, e)
/// turn as (x, y) do.
struct StraightEdge {
  double origin_x_um = 0.0;  ///< the point of the line that is nearest to the middle of the points
  double origin_y_um = 0.0;
  double origin_z_um = 0.0;
  double e_x = 0.0, e_y = 1.0;  ///< along
  double u_x = 1.0, u_y = 0.0;  ///< across
  double tilt = 0.0;            ///< dz along e
};

struct FoundPlanes {
  EdgeReason reason = EdgeReason::kNone;  ///< kTooFewPoints, kNotConvex, kRakeSideAmbiguous
  StraightEdge edge;
};

/// Hinging planes (Breiman 1993: each point belongs to the plane that is lower there) from many starts, then both
/// planes anew from the points at flank_from_um to flank_to_um from their line of intersection. Weights: Huber's, with
/// 1 / sigma^2 where sigma is known.
[[nodiscard]] FoundPlanes find_planes(const HeightField& field, const Region& region, const EdgeOptions& options);

}  // namespace fvd::metrology::edge
