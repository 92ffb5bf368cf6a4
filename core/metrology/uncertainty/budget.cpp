#include "core/metrology/uncertainty/budget.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>

#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>

namespace fvd::metrology {

double coverage_factor(double dof, double coverage) {
  assert(dof > 0.0 && coverage > 0.0 && coverage < 1.0);
  const double upper = 0.5 + 0.5 * coverage;
  if (std::isinf(dof)) return boost::math::quantile(boost::math::normal_distribution<double>(), upper);
  return boost::math::quantile(boost::math::students_t_distribution<double>(dof), upper);
}

std::optional<CombinedUncertainty> combined(const Budget& budget, double coverage) {
  if (budget.entries.empty()) return std::nullopt;
  double largest = 0.0;
  for (const BudgetEntry& entry : budget.entries) {
    assert(entry.u >= 0.0 && entry.dof > 0.0);
    largest = std::max(largest, entry.contribution());
  }
  CombinedUncertainty result;
  result.coverage = coverage;
  if (largest > 0.0) {
    // Relative to the largest, so that fourth powers of small figures stay numbers.
    double squares = 0.0;
    double per_dof = 0.0;
    for (const BudgetEntry& entry : budget.entries) {
      const double square = std::pow(entry.contribution() / largest, 2);
      squares += square;
      per_dof += square * square / entry.dof;
    }
    result.u = largest * std::sqrt(squares);
    result.dof = per_dof > 0.0 ? squares * squares / per_dof : kInfiniteDof;
  }
  result.k = coverage_factor(result.dof, coverage);
  result.expanded = result.k * result.u;
  return result;
}

BudgetEntry slice_z_entry(std::span<const double> sensitivities, std::span<const double> u_um) {
  assert(sensitivities.size() == u_um.size());
  double squares = 0.0;
  for (std::size_t j = 0; j < u_um.size(); ++j) {
    const double part = sensitivities[j] * u_um[j];
    squares += part * part;
  }
  BudgetEntry entry;
  entry.source = "slice_z";
  entry.u = std::sqrt(squares);
  return entry;
}

double slice_z_uncertainty_um(double measured_sd_um, double encoder_resolution_um) {
  assert(measured_sd_um >= 0.0 && encoder_resolution_um >= 0.0);
  return std::sqrt(measured_sd_um * measured_sd_um + encoder_resolution_um * encoder_resolution_um / 12.0);
}

}  // namespace fvd::metrology
