#pragma once

/// Notches in an edge line whose form is removed.

#include <span>
#include <vector>

#include "core/metrology/edge/edge_result.hpp"

namespace fvd::metrology::edge {

struct NotchLimits {
  double depth_um = 0.0;     ///< a notch is at least that deep
  double width_um = 0.0;     ///< and at half depth at least that wide, unless it is open
  double base_um = 0.0;      ///< where it leaves the form
  double resolved_um = 0.0;  ///< width from which on its depth is the true one
};

/// line: at equal steps. What lies between two places at the form is one notch. Own definition.
[[nodiscard]] std::vector<Notch> find_notches(std::span<const EdgeLinePoint> line, const NotchLimits& limits);

}  // namespace fvd::metrology::edge
