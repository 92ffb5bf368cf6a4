#pragma once

/// From the points of the sections to their figures, by the method that was asked for.

#include <span>
#include <vector>

#include "core/metrology/edge/edge_options.hpp"
#include "core/metrology/edge/edge_result.hpp"
#include "core/metrology/edge/section_data.hpp"
#include "core/metrology/height_field.hpp"

namespace fvd::metrology::edge {

struct EvaluatedSection {
  EdgeSection result;      ///< lengths of a rounding below nothing are negative here
  double apex_s_um = 0.0;  ///< where the flanks meet, in the section's frame
  double apex_h_um = 0.0;
};

/// One for each of the sections, in their order.
[[nodiscard]] std::vector<EvaluatedSection> evaluate_sections(std::span<const SectionData> sections,
                                                              const HeightField& field, const EdgeOptions& options);

/// Why a method never gives the quantity; kNone where it does.
[[nodiscard]] EdgeReason absent_by_method(EdgeQuantity quantity, EdgeMethod method) noexcept;

}  // namespace fvd::metrology::edge
