#pragma once

/// What a measurement of a cutting edge asks for.

namespace fvd::metrology {

/// The side of the edge, in the image, on which the rake face lies.
enum class RakeSide { kLeft, kRight, kTop, kBottom };

/// kConic: rounding of any asymmetry. kCircle: tangent circle only, K is 1 by definition.
/// kTolerance: the rounding begins where the contour leaves the flank's line by tolerance_um. Others do it so; it
/// shortens S by about sqrt(2 r t), and it is not corrected for the focus window.
enum class EdgeMethod { kConic, kCircle, kTolerance };

struct ChippingOptions {
  double min_depth_um = 3.0;   ///< > 0; five robust standard deviations of the edge line if those are more
  double min_width_um = 10.0;  ///< >= 0, at half depth
  int form_degree = 3;         ///< 0..6, of the robust polynomial that is taken off the edge line
};

struct EdgeOptions {
  RakeSide rake_side = RakeSide::kLeft;
  EdgeMethod method = EdgeMethod::kConic;
  double sections_every_um = 10.0;  ///< > 0, at least one pitch
  double flank_from_um = 15.0;      ///< > 0; distance from the edge in the image, at right angles to it
  double flank_to_um = 80.0;        ///< > flank_from_um; sections reach that far to both sides
  int bend_degree = 3;              ///< 1..3, of the edge in the image and in height along itself; 1 = straight
  double tolerance_um = 0.5;        ///< > 0, used by kTolerance
  ChippingOptions chipping;
};

}  // namespace fvd::metrology
