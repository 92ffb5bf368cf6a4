#pragma once

/// The response of the stage as straight line, lead error, reversal and drift, told apart by one least-squares fit.

#include <optional>
#include <string>
#include <vector>

#include "core/stage/stage_point.hpp"

namespace fvd {

/// A fitted value and its standard error, which is empty if no degree of freedom is left. The standard error assumes
/// independent residuals.
struct Estimate {
  double value = 0.0;
  std::optional<double> standard_error;
};

/// The error that repeats with every turn of the screw: A sin(2 pi z / lead + phase), z = quantised position.
struct LeadTerm {
  double lead_um = 0.0;
  Estimate amplitude_um;   ///< A >= 0
  double phase_deg = 0.0;  ///< in (-180, 180]
};

/// measured = offset + alpha_z z + lead term + reversal d / 2 + drift (t - mean t) + drift per kelvin (T - mean T),
/// with z = quantised position in um and d = the direction of approach. Least squares, all terms at once: alpha_z from
/// a straight line alone is biased by the lead error (see alpha_z_bias_bound), reversal and drift would hide in it too.
/// A term is left out, with a caveat, where the points cannot tell it from the terms before it (r^2 > 0.99).
struct StageFit {
  double offset_um = 0.0;           ///< at z = 0, mean time and temperature; mean of both directions if both occur
  std::optional<Estimate> alpha_z;  ///< amplification coefficient, slope of the response, 1 = ideal
  std::optional<LeadTerm> lead;
  std::optional<Estimate> reversal_um;       ///< from below minus from above, as a mean over the range
  std::optional<Estimate> drift_um_per_min;  ///< at constant temperature where drift_um_per_k was fitted beside it
  std::optional<Estimate> drift_um_per_k;
  /// drift_um_per_k is the drift rate over the rate of temperature, because time and temperature ran together.
  bool per_kelvin_from_rates = false;
  double residual_rms_um = 0.0;  ///< root of the sum of squares over the number of points
  int parameters = 0;            ///< number of fitted parameters
  double mean_time_s = 0.0;
  double mean_temperature_c = 0.0;  ///< 0 where no temperature was fitted
};

/// points: accepted by check_stage_points(), at least one, of a stage with feedback. Adds to `caveats` why a term is
/// missing. context: pure.
[[nodiscard]] StageFit fit_stage(const std::vector<StagePoint>& points, const StageReportOptions& options,
                                 std::vector<std::string>& caveats);

/// The fitted measured - quantised in um at a position, mean time and temperature. direction: +1, -1, or 0 for the mean
/// of both. context: pure.
[[nodiscard]] double fitted_error_um(const StageFit& fit, double quantised_um, int direction);

/// The drift by time and temperature that the fit contains at a point, in um. context: pure.
[[nodiscard]] double fitted_drift_um(const StageFit& fit, const StagePoint& point);

/// Largest change, over all phases, that a sine of amplitude A makes to the slope of a least-squares straight line over
/// an evenly covered range L: 12 A |2 sin(kL/2)/k^2 - L cos(kL/2)/k| / L^3 with k = 2 pi / lead; 6 A / (pi L) for
/// L = lead. All lengths > 0. context: pure.
[[nodiscard]] double alpha_z_bias_bound(double amplitude_um, double lead_um, double range_um);

}  // namespace fvd
