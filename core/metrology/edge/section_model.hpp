#pragma once

/// The model of one section across an edge: line, rounding, line, as seen through the focus window.

#include <cmath>
#include <numbers>
#include <vector>

#include "core/metrology/edge/rounding.hpp"
#include "core/metrology/edge/window_profile.hpp"

namespace fvd::metrology::edge {

/// s runs from the rake (negative) to the clearance; h upwards. The rake rises towards the apex at rake_rad, the
/// clearance falls from it at clearance_rad; their sum is positive for a convex edge.
struct SectionModel {
  double apex_s_um = 0.0;
  double apex_h_um = 0.0;
  double rake_rad = 0.0;
  double clearance_rad = 0.0;
  /// The square of the mean size sqrt(S_gamma S_alpha), with a sign. Below the window only this square shows in the
  /// section; noise may make it negative (material is added instead of taken away), and a mean over sections that had
  /// to leave such out would be too large.
  double signed_square_um2 = 0.0;
  double log_k = 0.0;       ///< ln(S_gamma / S_alpha)
  double log_weight = 0.0;  ///< ln of the conic's weight

  [[nodiscard]] double beta_rad() const { return std::numbers::pi - rake_rad - clearance_rad; }
  [[nodiscard]] double circle_log_weight() const { return std::log(std::sin(beta_rad() / 2.0)); }
  [[nodiscard]] double signed_size_um() const {
    return std::copysign(std::sqrt(std::abs(signed_square_um2)), signed_square_um2);
  }
  [[nodiscard]] double signed_radius_um() const { return signed_size_um() * std::tan(beta_rad() / 2.0); }
  /// The rounding without its sign.
  [[nodiscard]] Rounding rounding() const;
};

/// The averaged contour: the rounding is taken as a sum of many small kinks, each of which the window turns into its
/// mean distance, so that height and slope are exact up to the sum's spacing. Own definition.
class AveragedContour {
 public:
  AveragedContour(const SectionModel& model, const WindowProfile& window);
  [[nodiscard]] double height_um(double s_um) const;
  [[nodiscard]] double slope(double s_um) const;

 private:
  struct Kink {
    double s_um;
    double half_drop;  ///< of the slope
  };
  SectionModel model_;
  const WindowProfile* window_;
  std::vector<Kink> kinks_;
  double mean_slope_ = 0.0;
  double half_drop_ = 0.0;
  double left_um_ = 0.0;  ///< outside of left and right the contour is a straight line
  double right_um_ = 0.0;
};

}  // namespace fvd::metrology::edge
