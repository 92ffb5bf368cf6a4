#pragma once

/// Fields made of a formula, for tests.

#include <functional>

#include "core/metrology/height_field.hpp"

namespace fvd::metrology::test {

/// z_um(x_um, y_um) at the centres of the pixels; pitch 1 um.
inline HeightField made_field(int width, int height, const std::function<double(double, double)>& z_um) {
  HeightField field;
  field.z_um = Plane<double>(width, height);
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column) field.z_um.at(column, row) = z_um(column + 0.5, row + 0.5);
  }
  return field;
}

}  // namespace fvd::metrology::test
