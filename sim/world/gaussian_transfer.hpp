#pragma once

/// The exact transfer of a Gaussian blur, exp(-t (u^2 + v^2) / 2) with t = sigma^2 and u, v in radians per pixel, and
/// its interpolation between a few values of t.
///
/// Between the nodes the transfer is interpolated by the cubic through the four nearest nodes. With x = (u^2+v^2)/2 the
/// fourth derivative in t is x^4 exp(-t x): at most (2 pi^2 / 2)^4 near t = 0 and at most (4/t)^4 exp(-4) elsewhere.
/// The nodes lie 0.04 apart up to 0.16 and then grow by a quarter, which bounds the error of any frequency at any blur
/// below 0.1 % of full contrast; tests/sim/world checks the bound numerically.

#include <array>
#include <vector>

#include "core/image/image.hpp"

namespace fvd::sim {

/// The four nodes of which a blur is interpolated, and their weights.
struct TransferWeights {
  int first = 0;  ///< index of the first of four neighbouring nodes
  std::array<float, 4> weight{};
};

class TransferNodes {
 public:
  /// Nodes up to sigma_max pixels; a larger blur counts as sigma_max.
  explicit TransferNodes(double sigma_max);

  /// Values of t = sigma^2 at the nodes, px^2, ascending.
  [[nodiscard]] const std::vector<double>& t() const { return t_; }
  /// sigma: pixels, >= 0.
  [[nodiscard]] TransferWeights at(double sigma) const;

 private:
  std::vector<double> t_;
};

/// The periodic image blurred by sigma = sqrt(t) pixels, in the frequency domain.
class FrequencyBlur {
 public:
  explicit FrequencyBlur(const Plane<float>& image);
  [[nodiscard]] Plane<float> blurred(double t) const;

 private:
  int width_;
  int height_;
  std::vector<float> spectrum_;  // complex, [height][width][2]
};

}  // namespace fvd::sim
