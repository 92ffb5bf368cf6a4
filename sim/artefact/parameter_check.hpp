#pragma once

/// Dimensions of artefacts that do not go together.

#include <string>
#include <vector>

#include "sim/artefact/artefact_parameters.hpp"

namespace fvd::sim {

struct BadParameter {
  std::string pointer;  ///< "/groove/width_um"
  std::string message;
};

[[nodiscard]] std::vector<BadParameter> bad_parameters(const Groove& groove);
[[nodiscard]] std::vector<BadParameter> bad_parameters(const CrossGrid& grid);
/// reach_um: from the middle of the image to its corners.
[[nodiscard]] std::vector<BadParameter> bad_parameters(const CuttingEdge& edge, const Tilt& tilt, double reach_um);
[[nodiscard]] std::vector<BadParameter> bad_parameters(const ContrastMap& contrast);

}  // namespace fvd::sim
