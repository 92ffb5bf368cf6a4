#include "core/metrology/step/step_parts.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdio>

namespace fvd::metrology {

StepValue perpendicular_step(const HeightField& field, const PointGroups& groups, const JointLevels& levels, int upper,
                             int lower, SlopeAxes perpendicular, double sign) {
  StepValue step;
  step.slope_x = levels.slope_x();
  step.slope_y = levels.slope_y();
  const double along_x = perpendicular == SlopeAxes::kX || perpendicular == SlopeAxes::kBoth ? step.slope_x : 0.0;
  const double along_y = perpendicular == SlopeAxes::kY || perpendicular == SlopeAxes::kBoth ? step.slope_y : 0.0;
  const double stretch = std::sqrt(1.0 + along_x * along_x + along_y * along_y);
  step.vertical_um = sign * levels.difference_um(upper, lower);
  step.height_um = step.vertical_um / stretch;
  step.points = levels.points(upper) + levels.points(lower);
  const double per_slope = -step.vertical_um / (stretch * stretch * stretch);
  step.weights =
      levels.weights(field, groups, upper, lower, sign / stretch, {per_slope * along_x, per_slope * along_y});
  return step;
}

void add_scaled(const WeightMap& part, double factor, WeightMap& sum) {
  const int left = part.left - sum.left;
  const int top = part.top - sum.top;
  assert(left >= 0 && left + part.weights.width() <= sum.weights.width());
  assert(top >= 0 && top + part.weights.height() <= sum.weights.height());
  for (int row = 0; row < part.weights.height(); ++row) {
    const double* from = part.weights.row(row);
    double* to = sum.weights.row(top + row) + left;
    for (int column = 0; column < part.weights.width(); ++column) to[column] += factor * from[column];
  }
}

void summarize(StepTraces& traces) {
  assert(traces.each.size() >= 2);
  const auto count = static_cast<double>(traces.each.size());
  double sum = 0.0;
  for (const StepTrace& trace : traces.each) sum += trace.height_um;
  traces.mean_um = sum / count;
  double squares = 0.0;
  for (const StepTrace& trace : traces.each) squares += std::pow(trace.height_um - traces.mean_um, 2);
  traces.sd_um = std::sqrt(squares / (count - 1.0));
}

std::string figure_text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

std::optional<StepRefusal> refused_for_holes(std::span<const StepRegion> regions, double asked) {
  assert(!regions.empty());
  const StepRegion& worst = *std::min_element(
      regions.begin(), regions.end(),
      [](const StepRegion& a, const StepRegion& b) { return a.valid_fraction() < b.valid_fraction(); });
  if (worst.points > 0 && worst.valid_fraction() >= asked) return std::nullopt;
  return StepRefusal{StepRefusalCode::kTooFewValid,
                     "region " + worst.name + " has " + std::to_string(worst.points) + " of its " +
                         std::to_string(worst.asked) + " points, a fraction of " + figure_text(worst.valid_fraction()) +
                         " where " + figure_text(asked) + " is asked for",
                     worst.valid_fraction()};
}

}  // namespace fvd::metrology
