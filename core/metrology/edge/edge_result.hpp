#pragma once

/// What the measurement of a cutting edge gives.

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "core/metrology/edge/edge_options.hpp"

namespace fvd::metrology {

/// Words after ISO 3002-1 and DIN 6581. radius: of the circle that is tangent to both flanks and fits best (own
/// definition), corrected for the focus window; radius_apparent: the same without the correction. beta: wedge angle.
/// s_gamma, s_alpha: from the ideal apex to where the rounding leaves rake and clearance. k = s_gamma / s_alpha.
/// delta_r: least distance from apex to contour; phi: its direction against the bisector, positive towards the rake,
/// that is where K > 1.
/// r_min: least radius of curvature of the rounding. residual_rms: of the model's orthogonal distances.
enum class EdgeQuantity { kRadius, kRadiusApparent, kBeta, kSGamma, kSAlpha, kK, kDeltaR, kPhi, kRMin, kResidualRms };
inline constexpr std::size_t kEdgeQuantityCount = 10;
/// "radius_um", "radius_apparent_um", "beta_deg", "S_gamma_um", "S_alpha_um", "K", "delta_r_um", "phi_deg", "r_min_um",
/// "residual_rms_um".
[[nodiscard]] std::string_view edge_quantity_key(EdgeQuantity quantity) noexcept;

/// Why a value, a section or a whole edge could not be measured.
enum class EdgeReason {
  kNone,
  kTooFewPoints,        ///< the region holds too few points for two flanks
  kNotConvex,           ///< the flanks do not meet in a convex edge
  kRakeSideAmbiguous,   ///< the edge runs towards rake_side itself
  kFlankUnmeasured,     ///< under half of a flank's points are there
  kApexUnmeasured,      ///< under half of the points between the flanks are there
  kNotConverged,        ///< the model found no minimum, or one outside of the section
  kNoSection,           ///< no section of the edge could be measured
  kBelowResolution,     ///< the rounding is smaller than half a focus window
  kNotCorrected,        ///< the method knows no correction for the focus window
  kNotDefinedByMethod,  ///< the method gives no such value
  kTooFewSections,      ///< one section alone has no spread
  kNoSigma,             ///< the surface does not say its noise
  kEdgeLineTooShort     ///< too little of the edge line is measured
};
/// A plain sentence without a full stop; empty for kNone.
[[nodiscard]] std::string_view edge_reason_text(EdgeReason reason) noexcept;

/// One quantity over the edge. Either median is there or reason says why not.
struct EdgeValue {
  std::optional<double> median;          ///< over the measured sections
  std::optional<double> standard_error;  ///< of the median, from the spread of the sections
  std::optional<double> p10, p90;        ///< of the sections
  /// Standard uncertainty of the median: the larger of what the points' noise makes of a section and of the sections'
  /// spread, times 1.2533 / sqrt(n), with the noise that neighbouring sections share. Absent: u_reason.
  std::optional<double> u;
  std::optional<double> u_noise;  ///< the noise's part alone; it has infinitely many degrees of freedom
  bool at_most = false;           ///< the true value may be anything between 0 and radius_smallest_resolvable_um
  EdgeReason reason = EdgeReason::kNone;
  EdgeReason u_reason = EdgeReason::kNone;
};

struct EdgeSection {
  double along_um = 0.0;  ///< the section's middle, from the edge's first point in the region
  double x_um = 0.0;      ///< the apex in the image
  double y_um = 0.0;
  EdgeReason state = EdgeReason::kNone;                          ///< kNone = measured
  std::array<std::optional<double>, kEdgeQuantityCount> values;  ///< by EdgeQuantity
  std::array<std::optional<double>, kEdgeQuantityCount> u;       ///< from the points' noise; empty without sigma
  [[nodiscard]] std::optional<double> value(EdgeQuantity q) const { return values[static_cast<std::size_t>(q)]; }
};

struct Notch {
  double along_um = 0.0;  ///< deepest point
  double x_um = 0.0;
  double y_um = 0.0;
  double depth_um = 0.0;
  double width_um = 0.0;  ///< at half depth
  double area_um2 = 0.0;  ///< between edge line and form, from where it leaves the form by a robust standard deviation
  bool open = false;      ///< touches a part that is not measured: depth, width and area are at least that
  bool resolved = true;   ///< at least two focus windows wide; else the truth is deeper
};

/// A place of the edge line. distance: least distance from the contour to the fitted apex line.
struct EdgeLinePoint {
  double along_um = 0.0;
  double x_um = 0.0;
  double y_um = 0.0;
  std::optional<double> distance_um;   ///< absent = not measured
  std::optional<double> deviation_um;  ///< distance less its form; positive = material is missing
};

struct ChippingResult {
  EdgeReason reason = EdgeReason::kNone;  ///< why there are no figures
  std::vector<EdgeLinePoint> line;        ///< one every pitch
  std::optional<double> edge_pt_um;       ///< highest less lowest deviation of the whole line
  std::optional<double> edge_rz_um;       ///< mean of highest less lowest deviation over five equal parts
  double robust_sd_um = 0.0;              ///< of the deviations
  double depth_limit_um = 0.0;            ///< that was used
  std::vector<Notch> notches;             ///< along the edge
  double length_um = 0.0;                 ///< of the edge in the region
  double unmeasured_um = 0.0;             ///< of it without a contour; neither a notch nor a sound edge
  [[nodiscard]] double unmeasured_fraction() const { return length_um > 0.0 ? unmeasured_um / length_um : 1.0; }
  [[nodiscard]] double deepest_um() const;  ///< "chipping_max_um"; 0 without a notch
};

struct CuttingEdge {
  EdgeReason reason = EdgeReason::kNone;  ///< why there is nothing
  EdgeMethod method = EdgeMethod::kConic;
  double tolerance_um = 0.0;  ///< with kTolerance
  std::array<EdgeValue, kEdgeQuantityCount> values;
  std::vector<EdgeSection> sections;
  int sections_measured = 0;
  double direction_deg = 0.0;  ///< of the edge's middle in the image, 0..180, from x towards y (clockwise as seen)
  double window_um = 0.0;      ///< of the focus window across the edge
  double radius_smallest_resolvable_um = 0.0;  ///< half of it
  long points = 0;                             ///< used by the sections
  double valid_fraction = 0.0;                 ///< of the points that the sections could have had
  ChippingResult chipping;
  [[nodiscard]] const EdgeValue& value(EdgeQuantity q) const { return values[static_cast<std::size_t>(q)]; }
};

}  // namespace fvd::metrology
