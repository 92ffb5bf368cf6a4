#pragma once

/// Amplification and linearity along z, from steps of known height.

#include <span>
#include <vector>

#include "core/metrology/study/noise_study.hpp"

namespace fvd::metrology {

struct KnownStep {
  double reference_um = 0.0;    ///< of the certificate
  double u_reference_um = 0.0;  ///< standard uncertainty of the certificate; >= 0
  double measured_um = 0.0;
  double u_measured_um = 0.0;  ///< standard uncertainty of the measured mean; >= 0
};

struct ZAmplification {
  double alpha_z = 1.0;              ///< measured per true: divide measured heights by it
  double u_alpha_z = 0.0;            ///< from the stated uncertainties, see below
  std::vector<double> residuals_um;  ///< measured - alpha_z * reference, in the order of the steps
  double linearity_um = 0.0;         ///< l_z: the largest of them, absolute
  double u_linearity_um = 0.0;       ///< standard uncertainty of that residual's step, of measurement and certificate
  /// Sum of the squared residuals over their uncertainties, over n - 1: about 1 where the uncertainties explain them.
  /// 0 from one step, and where no uncertainties are stated.
  double reduced_chi_squared = 0.0;
};

/// measured = alpha_z * reference through zero, least squares with the weights 1 / (u_reference^2 + u_measured^2),
/// equal weights where all are 0. u_alpha_z is propagated from the weights, or where all are 0 from the scatter of the
/// residuals; u_common_relative, the part of the
/// certificates' uncertainty that all steps share (as a fraction of height), is added in quadrature, for it does not
/// average. ISO 25178-600:2019, 3.1.10 and 3.1.11 (alpha_z, l_z); method of ISO 25178-700. Refused where there is no
/// step or no reference other than 0, where only some of the uncertainties are 0, and for one step without any. Throws
/// Error(kBadInput) for figures that are not finite and uncertainties below 0. context: pure, as the next.
[[nodiscard]] StudyOutcome<ZAmplification> z_amplification(std::span<const KnownStep> steps,
                                                           double u_common_relative = 0.0);

struct StepAtZ {
  double z_um = 0.0;  ///< place of the step in the range
  double measured_um = 0.0;
};

struct ZLinearity {
  double mean_um = 0.0;
  double linearity_um = 0.0;     ///< l_z: the largest deviation from the mean, absolute
  double sd_um = 0.0;            ///< n - 1
  double trend_um_per_mm = 0.0;  ///< slope of the measured height over z
  std::vector<double> deviations_um;
};

/// One step measured at several z. Refused for fewer than two places of different z.
[[nodiscard]] StudyOutcome<ZLinearity> z_linearity(std::span<const StepAtZ> steps);

}  // namespace fvd::metrology
