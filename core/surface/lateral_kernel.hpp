#pragma once

/// What the focus window and the smoothing do to neighbouring points of a surface.

#include <vector>

namespace fvd {

/// Weights with which a height map averages the true surface, and with which neighbouring points share their errors:
/// errors are white noise averaged by these weights. Separable: the weight of the neighbour at (dx, dy) pixels is
/// weights[c + dx] * weights[c + dy] with c = size() / 2.
///
/// An odd number of weights, symmetric, sum 1. {1} means that nothing is averaged and that points are independent.
struct LateralKernel {
  std::vector<double> weights{1.0};
  /// What the focus operator adds along each axis to what the weights average: a variance, in squares of pixels. It
  /// widens what is seen of the surface; errors are shared by the weights alone.
  double operator_px2 = 0.0;

  [[nodiscard]] int reach_px() const { return static_cast<int>(weights.size() / 2); }
  /// The width of the window in pixels, measured on the kernel: that of a box of the same sum of squares.
  [[nodiscard]] double width_px() const {
    double squares = 0.0;
    for (const double weight : weights) squares += weight * weight;
    return 1.0 / squares;
  }
};

}  // namespace fvd
