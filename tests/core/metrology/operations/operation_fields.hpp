#pragma once

/// Surfaces for the tests of operations.

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "core/metrology/height_field.hpp"
#include "core/metrology/operations/operation_report.hpp"

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

inline void add_noise(HeightField& field, double sigma_um, unsigned seed) {
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> noise(0.0, sigma_um);
  for (double& z : field.z_um.pixels()) z += noise(generator);
}

inline void punch_holes(HeightField& field, double share, unsigned seed) {
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<double> uniform;
  for (double& z : field.z_um.pixels()) z = uniform(generator) < share ? kHole : z;
}

template <typename T>
[[nodiscard]] Plane<T> transposed(const Plane<T>& plane) {
  Plane<T> result(plane.height(), plane.width());
  for (int row = 0; row < plane.height(); ++row) {
    for (int column = 0; column < plane.width(); ++column) result.at(row, column) = plane.at(column, row);
  }
  return result;
}

template <typename T>
[[nodiscard]] Plane<T> mirrored(const Plane<T>& plane) {
  Plane<T> result(plane.width(), plane.height());
  for (int row = 0; row < plane.height(); ++row) {
    for (int column = 0; column < plane.width(); ++column) {
      result.at(plane.width() - 1 - column, row) = plane.at(column, row);
    }
  }
  return result;
}

[[nodiscard]] inline HeightField transposed(const HeightField& field) {
  return {transposed(field.z_um), transposed(field.sigma_um), field.pitch_y_um, field.pitch_x_um, field.kernel};
}

[[nodiscard]] inline HeightField mirrored(const HeightField& field) {
  return {mirrored(field.z_um), mirrored(field.sigma_um), field.pitch_x_um, field.pitch_y_um, field.kernel};
}

[[nodiscard]] inline std::size_t hole_count(const HeightField& field) {
  std::size_t holes = 0;
  for (const double z : field.z_um.pixels()) holes += std::isnan(z) ? 1U : 0U;
  return holes;
}

/// The largest |z| of the valid points.
[[nodiscard]] inline double largest(const HeightField& field) {
  double most = 0.0;
  for (const double z : field.z_um.pixels()) most = std::abs(z) > most ? std::abs(z) : most;
  return most;
}

/// The largest |left - right|; infinite where only one of them is a hole.
[[nodiscard]] inline double worst_difference(const Plane<double>& left, const Plane<double>& right) {
  double worst = 0.0;
  for (int row = 0; row < left.height(); ++row) {
    for (int column = 0; column < left.width(); ++column) {
      const double a = left.at(column, row);
      const double b = right.at(column, row);
      if (std::isnan(a) != std::isnan(b)) return std::numeric_limits<double>::infinity();
      if (!std::isnan(a)) worst = std::max(worst, std::abs(a - b));
    }
  }
  return worst;
}

[[nodiscard]] inline double value(const OperationReport& report, const char* name) {
  const NamedValue* found = report.find(name);
  return found == nullptr ? kHole : found->value;
}

[[nodiscard]] inline double error_of(const OperationReport& report, const char* name) {
  const NamedValue* found = report.find(name);
  return found == nullptr ? kHole : found->standard_error.value_or(kHole);
}

}  // namespace fvd::metrology
