#pragma once

/// Surfaces for the tests of step heights.

#include <cmath>
#include <limits>
#include <random>
#include <variant>

#include <gtest/gtest.h>

#include "core/metrology/height_field.hpp"
#include "core/metrology/step/refusal.hpp"
#include "core/metrology/uncertainty/weight_map.hpp"

namespace fvd::metrology {

inline constexpr double kHole = std::numeric_limits<double>::quiet_NaN();

/// height(x_um, y_um)
template <typename Height>
[[nodiscard]] HeightField make_field(int width, int height, double pitch_x_um, double pitch_y_um, const Height& z) {
  HeightField field;
  field.z_um = Plane<double>(width, height);
  field.pitch_x_um = pitch_x_um;
  field.pitch_y_um = pitch_y_um;
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column) {
      field.z_um.at(column, row) = z(field.x_um(column), field.y_um(row));
    }
  }
  return field;
}

inline void punch_holes(HeightField& field, double share, unsigned seed) {
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<double> uniform;
  for (double& z : field.z_um.pixels()) z = uniform(generator) < share ? kHole : z;
}

inline void add_white_noise(HeightField& field, double sigma_um, unsigned seed) {
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> noise(0.0, sigma_um);
  for (double& z : field.z_um.pixels()) z += noise(generator);
}

/// Rows and columns exchanged, pitches too.
[[nodiscard]] inline HeightField transposed(const HeightField& field) {
  HeightField result;
  result.z_um = Plane<double>(field.height(), field.width());
  for (int row = 0; row < field.height(); ++row) {
    for (int column = 0; column < field.width(); ++column) result.z_um.at(row, column) = field.z_um.at(column, row);
  }
  result.pitch_x_um = field.pitch_y_um;
  result.pitch_y_um = field.pitch_x_um;
  return result;
}

[[nodiscard]] inline HeightField mirrored(const HeightField& field) {
  HeightField result = field.clone();
  for (int row = 0; row < field.height(); ++row) {
    for (int column = 0; column < field.width(); ++column) {
      result.z_um.at(field.width() - 1 - column, row) = field.z_um.at(column, row);
    }
  }
  return result;
}

/// The outcome's value; fails the test and throws where it is a refusal.
template <typename T>
[[nodiscard]] T given(StepOutcome<T> outcome) {
  if (const auto* refusal = std::get_if<StepRefusal>(&outcome)) {
    ADD_FAILURE() << step_refusal_name(refusal->code) << ": " << refusal->text;
  }
  return std::get<T>(std::move(outcome));
}

template <typename T>
[[nodiscard]] StepRefusal refused(const StepOutcome<T>& outcome) {
  EXPECT_TRUE(std::holds_alternative<StepRefusal>(outcome));
  return std::get<StepRefusal>(outcome);
}

/// Compares the weights with what a change of single heights does to measure(field), at points all over the field.
template <typename Measure>
void expect_weights_are_derivatives(const HeightField& field, const WeightMap& weights, const Measure& measure,
                                    double tolerance) {
  constexpr double kChange = 1e-3;
  HeightField changed = field.clone();
  int with_weight = 0;
  for (int row = 0; row < field.height(); row += 3) {
    for (int column = row % 5; column < field.width(); column += 5) {
      if (field.is_hole(column, row)) {
        EXPECT_EQ(weights.at(column, row), 0.0);
        continue;
      }
      double& z = changed.z_um.at(column, row);
      const double before = z;
      z = before + kChange;
      const double above = measure(changed);
      z = before - kChange;
      const double below = measure(changed);
      z = before;
      EXPECT_NEAR(weights.at(column, row), (above - below) / (2.0 * kChange), tolerance) << column << ", " << row;
      with_weight += weights.at(column, row) != 0.0 ? 1 : 0;
    }
  }
  EXPECT_GT(with_weight, 20);
}

}  // namespace fvd::metrology
