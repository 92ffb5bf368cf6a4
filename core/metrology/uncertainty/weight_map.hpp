#pragma once

/// The weights of an estimate that is a linear function of a field's heights.

#include "core/image/image.hpp"

namespace fvd::metrology {

/// The estimate is, or changes as, the sum of weight * z over the points; a sum over squares, differences and means all
/// have this form. Points outside of the rectangle and holes of the field have the weight 0.
struct WeightMap {
  int left = 0;           ///< column of the field that is column 0 of the weights
  int top = 0;            ///< row of the field
  Plane<double> weights;  ///< [height][width], in the estimate's unit per um of height

  [[nodiscard]] WeightMap clone() const { return {left, top, weights.clone()}; }
  [[nodiscard]] double at(int column, int row) const {
    const int x = column - left;
    const int y = row - top;
    return x < 0 || y < 0 || x >= weights.width() || y >= weights.height() ? 0.0 : weights.at(x, y);
  }
};

}  // namespace fvd::metrology
