#include "core/metrology/study/step_linearity.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/base/error.hpp"

namespace fvd::metrology {
namespace {

void check(std::span<const KnownStep> steps, double u_common_relative) {
  bool good = std::isfinite(u_common_relative) && u_common_relative >= 0.0;
  for (const KnownStep& step : steps) {
    good = good && std::isfinite(step.reference_um) && std::isfinite(step.measured_um) &&
           std::isfinite(step.u_reference_um) && step.u_reference_um >= 0.0 && std::isfinite(step.u_measured_um) &&
           step.u_measured_um >= 0.0;
  }
  if (!good) throw Error(ErrorCode::kBadInput, "known steps are finite, their uncertainties not below 0");
}

double variance_of(const KnownStep& step) {
  return step.u_reference_um * step.u_reference_um + step.u_measured_um * step.u_measured_um;
}

std::optional<StudyRefusal> refusal_of(std::span<const KnownStep> steps, std::size_t without_u) {
  const bool any =
      std::any_of(steps.begin(), steps.end(), [](const KnownStep& step) { return step.reference_um != 0.0; });
  if (!any) return StudyRefusal{"no step with a known height other than 0"};
  if (without_u > 0 && without_u < steps.size()) {
    return StudyRefusal{std::to_string(without_u) + " of " + std::to_string(steps.size()) +
                        " steps have no uncertainty, so they cannot be weighed against the others"};
  }
  if (without_u == 1) return StudyRefusal{"one step without an uncertainty does not tell that of the amplification"};
  return std::nullopt;
}

}  // namespace

StudyOutcome<ZAmplification> z_amplification(std::span<const KnownStep> steps, double u_common_relative) {
  check(steps, u_common_relative);
  const auto without_u = static_cast<std::size_t>(
      std::count_if(steps.begin(), steps.end(), [](const KnownStep& step) { return variance_of(step) == 0.0; }));
  if (const std::optional<StudyRefusal> refusal = refusal_of(steps, without_u)) return *refusal;
  const bool weighted = without_u == 0;
  const auto weight = [&](const KnownStep& step) { return weighted ? 1.0 / variance_of(step) : 1.0; };

  double products = 0.0;
  double squares = 0.0;
  for (const KnownStep& step : steps) {
    products += weight(step) * step.measured_um * step.reference_um;
    squares += weight(step) * step.reference_um * step.reference_um;
  }
  ZAmplification result;
  result.alpha_z = products / squares;
  double chi_squared = 0.0;
  for (const KnownStep& step : steps) {
    const double residual = step.measured_um - result.alpha_z * step.reference_um;
    result.residuals_um.push_back(residual);
    chi_squared += weight(step) * residual * residual;
    if (result.residuals_um.size() > 1 && std::abs(residual) <= result.linearity_um) continue;
    result.linearity_um = std::abs(residual);
    result.u_linearity_um = std::sqrt(variance_of(step));
  }
  const double reduced = steps.size() > 1 ? chi_squared / static_cast<double>(steps.size() - 1) : 0.0;
  if (weighted) result.reduced_chi_squared = reduced;
  const double from_fit = std::sqrt((weighted ? 1.0 : reduced) / squares);
  result.u_alpha_z = std::hypot(from_fit, result.alpha_z * u_common_relative);
  return result;
}

StudyOutcome<ZLinearity> z_linearity(std::span<const StepAtZ> steps) {
  const auto n = static_cast<double>(steps.size());
  double mean_z = 0.0;
  ZLinearity result;
  for (const StepAtZ& step : steps) {
    mean_z += step.z_um / n;
    result.mean_um += step.measured_um / n;
  }
  const bool several =
      std::any_of(steps.begin(), steps.end(), [&](const StepAtZ& step) { return step.z_um != steps.front().z_um; });
  if (!several) return StudyRefusal{"the step was not measured at two places of different z"};
  double squares = 0.0;
  double squares_z = 0.0;
  double products = 0.0;
  for (const StepAtZ& step : steps) {
    const double deviation = step.measured_um - result.mean_um;
    result.deviations_um.push_back(deviation);
    result.linearity_um = std::max(result.linearity_um, std::abs(deviation));
    squares += deviation * deviation;
    squares_z += (step.z_um - mean_z) * (step.z_um - mean_z);
    products += (step.z_um - mean_z) * deviation;
  }
  result.sd_um = std::sqrt(squares / (n - 1.0));
  result.trend_um_per_mm = 1000.0 * products / squares_z;
  return result;
}

}  // namespace fvd::metrology
