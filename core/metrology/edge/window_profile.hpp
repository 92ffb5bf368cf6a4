#pragma once

/// The focus window as a section across an edge sees it.

#include <vector>

#include "core/surface/lateral_kernel.hpp"

namespace fvd::metrology::edge {

/// The density k(s) of the window, projected on one direction of the image: each weight of the kernel counts for the
/// area of its pixel, so that a box of 9 weights and 1 um is 9 um wide, and widened by what the focus operator adds
/// (kernel.operator_px2). Own definition.
/// What the window makes of a surface that bends along straight lines only is told by one function, the mean of the
/// distance: |s| averaged by k. context: any thread once it is made.
class WindowProfile {
 public:
  /// direction_x, direction_y: unit vector in the image.
  WindowProfile(const LateralKernel& kernel, double pitch_x_um, double pitch_y_um, double direction_x,
                double direction_y);

  /// Integral of |s - t| k(t) dt, um. |s| itself beyond reach_um().
  [[nodiscard]] double mean_distance_um(double s_um) const;
  /// Its first derivative, -1 to 1.
  [[nodiscard]] double mean_sign(double s_um) const;
  [[nodiscard]] double reach_um() const { return reach_um_; }
  /// That of a box with the same integral of k^2, of the weights alone: errors are shared over this width.
  [[nodiscard]] double width_um() const { return width_um_; }

 private:
  double reach_um_ = 0.0;
  double width_um_ = 0.0;
  double step_um_ = 0.0;
  std::vector<double> distance_;  ///< at i * step_um_
  std::vector<double> sign_;
};

}  // namespace fvd::metrology::edge
