#pragma once

/// What a step height is made of, whatever the method.

#include <optional>
#include <string>
#include <vector>

#include "core/metrology/height_field.hpp"
#include "core/metrology/uncertainty/linear_noise.hpp"
#include "core/metrology/uncertainty/weight_map.hpp"

namespace fvd::metrology {

enum class Across { kX, kY };  ///< the direction of the traces; the groove runs the other way

/// Ignored where a method has no use for it.
struct StepRegion {
  std::string name;  ///< "A", "B", "C", or the region's own
  int points = 0;    ///< valid ones
  int asked = 0;     ///< points that the region has, with holes and what lies outside of the field
  double mean_z_um = 0.0;
  [[nodiscard]] double valid_fraction() const { return asked > 0 ? static_cast<double>(points) / asked : 0.0; }
};

/// A height with all that its uncertainty needs.
struct StepValue {
  double height_um = 0.0;    ///< perpendicular to the common plane or line: vertical / sqrt(1 + slope^2)
  double vertical_um = 0.0;  ///< along z
  double slope_x = 0.0;      ///< um per um; 0 where the fit has none in that direction
  double slope_y = 0.0;
  int points = 0;                    ///< used
  WeightMap weights;                 ///< derivatives of height_um to the heights of the field
  std::optional<LinearNoise> noise;  ///< of height_um, from the sigma map; absent where the field has none
};

struct StepTrace {
  double from_um = 0.0;  ///< of the strip, across the trace, from the field's outer corner
  double to_um = 0.0;
  double height_um = 0.0;
  double slope = 0.0;  ///< along the trace
  int points = 0;
};

/// Mean and spread over the traces. u of the mean honours the noise of neighbouring traces that see the same points.
struct StepTraces {
  std::vector<StepTrace> each;
  int left_out = 0;  ///< traces with too few valid points
  double mean_um = 0.0;
  double sd_um = 0.0;  ///< standard deviation of the traces' heights, n - 1
};

}  // namespace fvd::metrology
