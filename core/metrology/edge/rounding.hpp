#pragma once

/// The shape of the rounding between two flanks: a conic that is tangent to both.

namespace fvd::metrology::edge {

/// A rational quadratic curve with the ideal apex as its control point: it leaves the rake at the distance s_gamma from
/// the apex and the clearance at s_alpha. weight > 0; an arc of an ellipse below 1, of a parabola at 1, of a hyperbola
/// above. A circle where s_gamma = s_alpha and weight = sin(beta / 2). Own definition; the words after ISO 3002-1.
struct Rounding {
  double beta_rad = 0.0;  ///< wedge angle, 0..pi
  double s_gamma_um = 0.0;
  double s_alpha_um = 0.0;
  double weight = 1.0;

  /// The circle of this radius: s = r / tan(beta / 2).
  [[nodiscard]] static Rounding circle(double beta_rad, double radius_um);
};

/// The point of the rounding that is nearest to the ideal apex.
struct NearestPoint {
  double delta_r_um = 0.0;  ///< its distance
  double phi_deg = 0.0;     ///< its direction against the bisector of the wedge; positive = moved towards the rake, as
                            ///< where s_gamma > s_alpha: the point itself is then on the clearance's side
};

[[nodiscard]] NearestPoint nearest_to_apex(const Rounding& rounding);
/// The least radius of curvature, ends included. With H(u) = (X, Y, W) the homogeneous curve, the curvature is
/// W^3 det(H, H', H'') / |(X'W - XW', Y'W - YW')|^3 (Farin, Curves and Surfaces for CAGD, 5th edition, 13.6).
[[nodiscard]] double least_radius_um(const Rounding& rounding);

}  // namespace fvd::metrology::edge
