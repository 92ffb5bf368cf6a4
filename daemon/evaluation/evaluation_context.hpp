#pragma once

/// What an evaluation knows beside the surface.

#include <memory>
#include <optional>
#include <vector>

#include "core/metrology/height_field.hpp"
#include "daemon/result/calibration.hpp"
#include "daemon/result/repeatability.hpp"

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

  std::optional<Calibration> calibration = {};  ///< of the instrument; absent = none
  /// The map that the calibration names, with its standard errors; null = not at hand. Heights as scans gave them: they
  /// are divided by alpha_z, as the surface's are, where the map is put to use.
  std::shared_ptr<const metrology::HeightField> flatness_reference = nullptr;
  std::optional<double> temperature_c = {};
  RepeatabilityMap repeatability = {};  ///< of the recipe's values; empty = no gauge study
  bool operator==(const EvaluationContext&) const = default;
};

}  // namespace fvd
