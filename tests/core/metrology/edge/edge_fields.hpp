#pragma once

/// Height fields of wedges, averaged over the window's box by fine oversampling.

#include <cstdint>

#include "core/metrology/height_field.hpp"

namespace fvd::metrology::edge_test {

/// The truth: a wedge whose flanks fall by rake_deg and clearance_deg, rounded by a conic.
struct WedgeTruth {
  double rake_deg = 45.0;
  double clearance_deg = 45.0;
  double s_gamma_um = 0.0;  ///< 0 = sharp
  double s_alpha_um = 0.0;
  double weight = 0.7071067811865476;
  double direction_deg = 90.0;  ///< of the edge in the image, from x towards y; the clearance lies at 90 deg less
  double middle_x_um = 0.0;     ///< a point of the edge
  double middle_y_um = 0.0;
  double apex_z_um = 100.0;
  double tilt = 0.0;            ///< dz along the edge in the image
  double bend_per_um = 0.0;     ///< curvature of the edge in the image
  double notch_along_um = 1e9;  ///< from the middle point; the edge is cut off flat there
  double notch_depth_um = 0.0;
  double notch_width_um = 0.0;

  /// The circle's S and weight.
  void set_circle(double radius_um);
  /// Height of the true surface.
  [[nodiscard]] double height_um(double x_um, double y_um) const;
};

/// Box of window_px, pitch 1 um, and sigma_um of noise averaged by the same box (0 = none). sigma of the field is
/// sigma_um, or 0.1 without noise. The points of a window are the means over 5 x 5 places of each pixel.
[[nodiscard]] HeightField make_field(const WedgeTruth& truth, int width, int height, int window_px, double sigma_um,
                                     std::uint64_t seed);

}  // namespace fvd::metrology::edge_test
