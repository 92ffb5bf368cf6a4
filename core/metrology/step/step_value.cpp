#include "core/metrology/step/step_value.hpp"

#include <cmath>

namespace fvd::metrology {

StepValue step_value(const HeightField& field, const PointGroups& groups, const JointLevels& levels, int upper,
                     int lower, double sign) {
  const double a = levels.slope_x();
  const double b = levels.slope_y();
  const double square = 1.0 + a * a + b * b;
  const double root = std::sqrt(square);
  StepValue value;
  value.vertical_um = sign * levels.difference_um(upper, lower);
  value.height_um = value.vertical_um / root;
  value.slope_x = a;
  value.slope_y = b;
  for (int group = 1; group <= groups.count; ++group) value.points += levels.points(group);
  const double per_slope = -value.vertical_um / (square * root);
  value.weights = levels.weights(field, groups, upper, lower, sign / root, {per_slope * a, per_slope * b});
  if (field.has_sigma()) value.noise = linear_noise(field, value.weights);
  return value;
}

}  // namespace fvd::metrology
