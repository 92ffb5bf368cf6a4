#include "core/metrology/study/gauge_type1.hpp"

#include <algorithm>
#include <cmath>

#include <boost/math/distributions/students_t.hpp>

#include "core/base/error.hpp"

namespace fvd::metrology {
namespace {

void check(std::span<const double> values, const GaugeType1Settings& settings) {
  if (values.size() < 2) throw Error(ErrorCode::kBadInput, "a gauge study of one part needs at least 2 values");
  const bool finite = std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
  if (!finite || !std::isfinite(settings.reference)) {
    throw Error(ErrorCode::kBadInput, "a gauge study takes finite values only");
  }
  if (!(settings.tolerance > 0.0 && settings.tolerance_share > 0.0 && settings.spread_sd > 0.0)) {
    throw Error(ErrorCode::kBadInput, "tolerance, its share and the spread of a gauge study must be above 0");
  }
}

double two_sided_p(double t, double dof) {
  return 2.0 * boost::math::cdf(boost::math::complement(boost::math::students_t_distribution<double>(dof), t));
}

}  // namespace

GaugeType1 gauge_type1(std::span<const double> values, const GaugeType1Settings& settings) {
  check(values, settings);
  const auto n = static_cast<double>(values.size());
  GaugeType1 study;
  study.n = static_cast<int>(values.size());
  // From the first value on, so that equal values have no scatter of rounding.
  double sum = 0.0;
  for (const double value : values) sum += value - values.front();
  study.mean = values.front() + sum / n;
  study.bias = study.mean - settings.reference;
  double squares = 0.0;
  for (const double value : values) squares += std::pow(value - study.mean, 2);
  study.sd = std::sqrt(squares / (n - 1.0));
  if (settings.resolution) study.resolution_percent = 100.0 * *settings.resolution / settings.tolerance;

  const double usable = settings.tolerance_share * settings.tolerance;
  const double bias = std::abs(study.bias);
  if (study.sd == 0.0) {
    study.bias_significant = bias > 0.0;
    study.capable = bias <= 0.5 * usable;
    return study;
  }
  const double spread = settings.spread_sd * study.sd;
  study.cg = usable / spread;
  study.cgk = (0.5 * usable - bias) / (0.5 * spread);
  study.t = bias * std::sqrt(n) / study.sd;
  study.p_value = two_sided_p(*study.t, n - 1.0);
  study.bias_significant = *study.p_value < 0.05;
  study.capable = *study.cg >= settings.required && *study.cgk >= settings.required;
  return study;
}

}  // namespace fvd::metrology
