#pragma once

/// Surfaces and shortcuts for the tests of areal parameters.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <vector>

#include "core/metrology/areal/evaluate_areal.hpp"

namespace fvd::metrology::testing {

inline constexpr double kHole = std::numeric_limits<double>::quiet_NaN();
inline constexpr double kPi = std::numbers::pi;

/// z_um(x_um, y_um) at the points of a field.
template <typename Height>
HeightField make_field(int width, int height, double pitch_x_um, double pitch_y_um, Height&& z_um) {
  HeightField field;
  field.z_um = Plane<double>(width, height);
  field.pitch_x_um = pitch_x_um;
  field.pitch_y_um = pitch_y_um;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) field.z_um.at(x, y) = z_um(field.x_um(x), field.y_um(y));
  }
  return field;
}

/// One row of the given heights.
inline HeightField row_of(const std::vector<double>& heights_um) {
  HeightField field;
  field.z_um = Plane<double>(static_cast<int>(heights_um.size()), 1);
  std::copy(heights_um.begin(), heights_um.end(), field.z_um.pixels().begin());
  return field;
}

inline std::vector<ArealParameter> all_parameters() {
  std::vector<ArealParameter> parameters;
  for (const ArealParameterInfo& info : areal_parameters()) parameters.push_back(info.parameter);
  return parameters;
}

/// All values, by their parameter.
class AllValues {
 public:
  explicit AllValues(const HeightField& field, const Region& region = {}, const ArealSettings& settings = {})
      : evaluation_(evaluate_areal(field, region, all_parameters(), settings)) {}

  [[nodiscard]] const ArealValue& operator[](ArealParameter parameter) const {
    return evaluation_.values.at(static_cast<std::size_t>(parameter));
  }
  /// The number; NaN where there is none, which fails every comparison.
  [[nodiscard]] double number(ArealParameter parameter) const { return (*this)[parameter].value.value_or(kHole); }
  [[nodiscard]] const ArealEvaluation& evaluation() const { return evaluation_; }

 private:
  ArealEvaluation evaluation_;
};

}  // namespace fvd::metrology::testing
