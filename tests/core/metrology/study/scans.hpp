#pragma once

/// Scans of a flat with white noise, for the tests of studies.

#include <cstdint>
#include <vector>

#include "core/metrology/height_field.hpp"
#include "core/metrology/uncertainty/random_normal.hpp"

namespace fvd::metrology::testing {

inline HeightField scan(int width, int height, std::uint64_t seed, double noise_um) {
  HeightField field{Plane<double>(width, height), {}, 0.5, 0.4, {}};
  RandomNormal random(seed);
  for (double& z : field.z_um.pixels()) z = noise_um * random.normal();
  return field;
}

inline void add_plane(HeightField& field, double offset_um, double slope_x, double slope_y) {
  for (int y = 0; y < field.height(); ++y) {
    for (int x = 0; x < field.width(); ++x) {
      field.z_um.at(x, y) += offset_um + slope_x * field.x_um(x) + slope_y * field.y_um(y);
    }
  }
}

inline std::vector<const HeightField*> pointers(const std::vector<HeightField>& scans) {
  std::vector<const HeightField*> result;
  for (const HeightField& field : scans) result.push_back(&field);
  return result;
}

}  // namespace fvd::metrology::testing
