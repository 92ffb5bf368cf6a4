#pragma once

/// What an evaluation knows beside the surface.

#include <optional>
#include <string>
#include <vector>

namespace fvd {

/// One sample of the focus curves: a slice, or the slices of a bin.
struct CurveSample {
  double z_um = 0.0;
  double u_um = 0.0;  ///< standard uncertainty of that z
  bool operator==(const CurveSample&) const = default;
};

struct EvaluationContext {
  std::vector<CurveSample> samples;  ///< in the order of the scan; fewer than 3 = not known
  double curve_width_um = 0.0;       ///< full width at half maximum of the focus curves; 0 = not known
  bool operator==(const EvaluationContext&) const = default;
};

}  // namespace fvd
