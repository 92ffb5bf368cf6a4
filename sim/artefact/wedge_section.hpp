#pragma once

/// The section of a cutting edge: two flanks and the rounding between them.
///
/// The rounding is the rational quadratic with the ideal apex as its control point,
///   p(t) = (P0 a^2 + P2 b^2) / D,  a = 1 - t, b = t, D = a^2 + 2 w a b + b^2,
/// P0 and P2 at S_gamma and S_alpha from the apex on rake and clearance: tangent to both flanks; w = sin(beta / 2) and
/// equal S make a circle of radius S tan(beta / 2). Own definition; the words are those of ISO 3002-1 and of common
/// use.

#include "sim/artefact/artefact_parameters.hpp"

namespace fvd::sim {

/// A place in the section, um from the ideal apex: s across the edge, positive towards the clearance; h upwards.
struct SectionPoint {
  double s_um = 0.0;
  double h_um = 0.0;
};

/// What an evaluation of the section should find.
struct WedgeTruth {
  double beta_deg = 0.0;
  double s_gamma_um = 0.0;
  double s_alpha_um = 0.0;
  double weight = 1.0;
  std::optional<double> k;          ///< S_gamma / S_alpha; a sharp edge has none
  std::optional<double> radius_um;  ///< of a circle, 0 if sharp; a conic has none
  double delta_r_um = 0.0;          ///< least distance from apex to contour
  std::optional<double> phi_deg;    ///< its direction out of the contour against the bisector, positive towards
                                    ///< the rake: so it is where K is above 1
  double r_min_um = 0.0;            ///< least radius of curvature
};

/// context: any thread.
class WedgeSection {
 public:
  /// lean_deg: turn of the section about the apex that raises the clearance.
  WedgeSection(const CuttingEdge& edge, double lean_deg);

  /// Height over the apex of the contour at s.
  [[nodiscard]] double height_um(double s_um) const;
  /// The same with a chip that takes the contour notch_um further from the apex, 0 or more.
  [[nodiscard]] double height_um(double s_um, double notch_um) const;
  /// The rounding at t, 0 on the rake to 1 on the clearance.
  [[nodiscard]] SectionPoint rounding(double t) const;
  [[nodiscard]] double curvature_radius_um(double t) const;
  [[nodiscard]] const WedgeTruth& truth() const { return truth_; }

 private:
  void find_nearest();

  WedgeTruth truth_;
  SectionPoint rake_;       // unit vectors from the apex down the flanks, turned
  SectionPoint clearance_;  // ...
  SectionPoint p0_;
  SectionPoint p2_;
  SectionPoint towards_nearest_;  // unit vector from the apex
};

}  // namespace fvd::sim
