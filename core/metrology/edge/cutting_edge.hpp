#pragma once

/// The rounding of a cutting edge and its chipping, from a height field.

#include "core/metrology/edge/edge_options.hpp"
#include "core/metrology/edge/edge_result.hpp"
#include "core/metrology/height_field.hpp"

namespace fvd::metrology {

/// Finds the one convex edge of the region (empty: of the field), in any direction of the image, cuts it into sections
/// at right angles to it in space, and fits line, rounding, line to each. The field's kernel corrects for the focus
/// window; its sigma gives weights and uncertainties. Holes stay holes. Never throws for data: what cannot be given is
/// absent with a reason. Options outside their stated ranges are a bug of the caller, and so is a region of another
/// shape than the field. Formulas: ISO 3002-1 and DIN 6581 for the words, model and statistics own definition.
/// context: any thread. Cost: about 10 ms a section.
[[nodiscard]] CuttingEdge measure_cutting_edge(const HeightField& field, const Region& region,
                                               const EdgeOptions& options);

}  // namespace fvd::metrology
