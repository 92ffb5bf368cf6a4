#pragma once

/// The upright rectangles around the regions of a plan.

#include <limits>
#include <optional>
#include <set>
#include <string>

#include "core/metrology/operations/region.hpp"
#include "daemon/evaluation/evaluation_plan.hpp"

namespace fvd {

/// In um; everything where it is not bounded.
struct BoxUm {
  double left = -std::numeric_limits<double>::infinity();
  double top = -std::numeric_limits<double>::infinity();
  double right = std::numeric_limits<double>::infinity();
  double bottom = std::numeric_limits<double>::infinity();

  [[nodiscard]] bool empty() const { return left > right || top > bottom; }
};

[[nodiscard]] BoxUm common_box(const BoxUm& a, const BoxUm& b);
[[nodiscard]] BoxUm box_of(const PlannedRectangle& rectangle);
[[nodiscard]] BoxUm box_of(const metrology::Grid& field);

/// Of a rectangle, polygon or circle without its shrink_um; nothing for other shapes, which are not drawn.
[[nodiscard]] std::optional<BoxUm> drawn_box(const PlannedRegion& region);

/// No point of the region lies outside of the box. A name that leads nowhere or in a circle has no bounds. field: may
/// be null; with it shrink_um counts too. context: pure.
[[nodiscard]] BoxUm region_box(const EvaluationPlan& plan, const std::string& name, const metrology::Grid* field);

}  // namespace fvd
