#pragma once

/// The edge line and its notches.

#include "core/metrology/edge/edge_curve.hpp"
#include "core/metrology/edge/edge_options.hpp"
#include "core/metrology/edge/edge_result.hpp"
#include "core/metrology/height_field.hpp"

namespace fvd::metrology::edge {

/// curve: through the fitted apexes. window_um: of the focus window along the edge. The contour is bilinear between
/// points; where one of the four is a hole it has no place there, and a place of the edge line counts as measured only
/// if nothing is missing that might be nearer to the apex than what is there, and if half of both flanks beside it is
/// there. Own definition.
[[nodiscard]] ChippingResult measure_chipping(const HeightField& field, const Region& region, const EdgeCurve& curve,
                                              double window_um, const EdgeOptions& options);

}  // namespace fvd::metrology::edge
