#include "core/metrology/uncertainty/decision.hpp"

#include <cassert>
#include <cmath>

#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>

namespace fvd::metrology {
namespace {

/// P(T <= t)
double lower_tail(double t, double dof) {
  if (std::isinf(dof)) return boost::math::cdf(boost::math::normal_distribution<double>(), t);
  return boost::math::cdf(boost::math::students_t_distribution<double>(dof), t);
}

Verdict by_probability(double conformity, double probability) {
  if (conformity >= probability) return Verdict::kPass;
  if (1.0 - conformity >= probability) return Verdict::kFail;
  return Verdict::kUncertain;
}

Verdict by_guard(double value, double guard, const Limits& limits) {
  const bool outside =
      (limits.lower && value < *limits.lower - guard) || (limits.upper && value > *limits.upper + guard);
  if (outside) return Verdict::kFail;
  const bool inside =
      (!limits.lower || value >= *limits.lower + guard) && (!limits.upper || value <= *limits.upper - guard);
  return inside ? Verdict::kPass : Verdict::kUncertain;
}

Verdict by_rule(double value, const std::optional<CombinedUncertainty>& uncertainty, const Limits& limits,
                const DecisionSettings& settings, std::optional<double> conformity) {
  if (settings.rule == DecisionRule::kSimple) return judge(value, limits);
  if (!uncertainty) return Verdict::kUncertain;
  if (settings.rule == DecisionRule::kGuardU) return by_guard(value, uncertainty->expanded, limits);
  return by_probability(*conformity, settings.probability);
}

}  // namespace

double conformity_probability(double value, double u, double dof, const Limits& limits) {
  assert(u >= 0.0 && dof > 0.0);
  if (u == 0.0) return judge(value, limits) == Verdict::kPass ? 1.0 : 0.0;
  // Both as lower tails: a small probability keeps its digits.
  const double below = limits.lower ? lower_tail((*limits.lower - value) / u, dof) : 0.0;
  const double above = limits.upper ? lower_tail((value - *limits.upper) / u, dof) : 0.0;
  return std::fmax(0.0, 1.0 - below - above);
}

Decision decide(std::optional<double> value, const std::optional<CombinedUncertainty>& uncertainty,
                const Limits& limits, const DecisionSettings& settings, bool below_noise) {
  assert(settings.probability > 0.5 && settings.probability < 1.0);
  Decision decision;
  if (!value || !std::isfinite(*value)) return decision;
  if (!limits.lower && !limits.upper) {
    decision.verdict = Verdict::kPass;
    return decision;
  }
  if (uncertainty) {
    decision.conformity = conformity_probability(*value, uncertainty->u, uncertainty->dof, limits);
    if (limits.lower && limits.upper) {
      decision.u_above_third_of_tolerance = 3.0 * uncertainty->u > *limits.upper - *limits.lower;
    }
  }
  decision.verdict = by_rule(*value, uncertainty, limits, settings, decision.conformity);
  if (below_noise && limits.lower && decision.verdict == Verdict::kPass) {
    decision.verdict = Verdict::kUncertain;
    decision.held_back_below_noise = true;
  }
  return decision;
}

}  // namespace fvd::metrology
