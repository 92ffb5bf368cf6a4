#pragma once

/// Surfaces, slices and evaluations of them, for tests.

#include <cmath>
#include <functional>
#include <string>

#include <gmock/gmock.h>

#include "daemon/evaluation/evaluate_surface.hpp"
#include "tests/daemon/evaluation/planned.hpp"

namespace fvd::test {

inline constexpr int kColumns = 300;
inline constexpr int kRows = 60;

/// 60 rows of points 1 um apart with a standard error of 0.2 um, through a window of 9 points.
inline Surface surface_of(const std::function<double(double x_um, double y_um)>& z_um, int columns = kColumns) {
  Surface surface;
  surface.height_m = Plane<float>(columns, kRows);
  surface.sigma_m = Plane<float>(columns, kRows, 0.2e-6F);
  surface.pitch_x_um = 1.0;
  surface.pitch_y_um = 1.0;
  surface.kernel.weights.assign(9, 1.0 / 9.0);
  for (int row = 0; row < kRows; ++row) {
    for (int column = 0; column < columns; ++column) {
      surface.height_m.at(column, row) = static_cast<float>(1e-6 * z_um(column + 0.5, row + 0.5));
    }
  }
  return surface;
}

/// From x = 105 um to 195 um.
inline Surface level_groove(double depth_um = 50.0) {
  return surface_of(
      [depth_um](double x_um, double) { return x_um > 105.0 && x_um < 195.0 ? 100.0 - depth_um : 100.0; });
}

/// Slices 10 um apart, each known to 0.01 um.
inline EvaluationContext known_slices() {
  EvaluationContext context;
  context.curve_width_um = 28.0;
  for (int i = 0; i < 21; ++i) context.samples.push_back({-7.0 + 10.0 * i, 0.01});
  return context;
}

inline Evaluation evaluated(const Surface& surface, const std::string& json, const EvaluationContext& context) {
  Problems problems;
  const EvaluationPlan plan = read_plan(json, problems);
  EXPECT_THAT(problems, ::testing::IsEmpty());
  return evaluate_surface(surface, plan, context, nullptr);
}

/// u of that source in the value's budget; NaN where it has none.
inline double u_of(const EvaluatedValue& value, const std::string& source) {
  for (const UncertaintyLine& line : value.budget) {
    if (line.source == source) return line.u;
  }
  return std::nan("");
}

}  // namespace fvd::test
