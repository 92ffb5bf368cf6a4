#pragma once

/// Lateral scale from the crossings of a cross grid, whose places in the image are given.

#include <optional>
#include <span>
#include <vector>

#include "core/metrology/study/noise_study.hpp"

namespace fvd::metrology {

struct GridCrossing {
  double column = 0.0;  ///< place in the image in pixels, 0 = centre of the first
  double row = 0.0;
  int index_x = 0;  ///< number of the grid's line, counted along the image's x as far as the grid is turned
  int index_y = 0;
};

struct LateralGrid {
  double pitch_x_um = 0.0;  ///< length of a step of one column
  double pitch_y_um = 0.0;  ///< distance of neighbouring rows, perpendicular to x
  double shear = 0.0;      ///< x that a step of one row adds, over pitch_y_um: tangent of the axes' missing right angle
  double angle_deg = 0.0;  ///< of the grid's x lines against the image's x, positive towards y (clockwise as seen)
  double u_pitch_x_um = 0.0;  ///< standard uncertainties, from the residuals and the grid's own
  double u_pitch_y_um = 0.0;
  double deviation_max_um = 0.0;  ///< mapping deviations: largest and root mean square distance
  double deviation_rms_um = 0.0;
  std::vector<double>
      deviations_x_um;  ///< in the order of the crossings, in the image's axes: place seen - place by the fit
  std::vector<double> deviations_y_um;
};

/// Affine map, least squares over the places in the image. grid_pitch_um > 0, u_grid_relative: standard uncertainty of
/// the grid's pitch over the pitch. ISO 25178-600:2019, 3.1.10 (alpha_x, alpha_y) and 3.1.13 (mapping deviations).
/// Refused for fewer than six crossings, crossings in one line, or indices that run as in a mirror (x right, y down).
/// Throws Error(kBadInput) for a grid_pitch_um or u_grid_relative out of range. context: pure, as the next.
[[nodiscard]] StudyOutcome<LateralGrid> lateral_grid(std::span<const GridCrossing> crossings, double grid_pitch_um,
                                                     double u_grid_relative = 0.0);

struct LateralDrift {
  double x_px_per_um = 0.0;           ///< movement of the crossings' mean place to the right, and
  double y_px_per_um = 0.0;           ///< down, per um of z
  double magnification_per_mm = 0.0;  ///< relative change of the picture's size per mm of z
  int crossings = 0;                  ///< seen at both heights
};

/// The same grid at two heights, from crossings with the same indices; least squares of a movement and a change of size
/// about the crossings' mean place. The movement of another place has the change of size in it. Own definition. Refused
/// for fewer than six of them or equal z.
[[nodiscard]] StudyOutcome<LateralDrift> lateral_drift(std::span<const GridCrossing> at_first, double z_first_um,
                                                       std::span<const GridCrossing> at_second, double z_second_um);

}  // namespace fvd::metrology
