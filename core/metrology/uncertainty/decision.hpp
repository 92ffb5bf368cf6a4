#pragma once

/// Whether a value conforms to its limits, with its uncertainty.

#include <optional>

#include "core/metrology/uncertainty/budget.hpp"
#include "core/surface/verdict.hpp"

namespace fvd::metrology {

enum class DecisionRule {
  kIso14253,  ///< ISO 14253-1:2017: stated where its probability is at least `probability`, else uncertain
  kSimple,    ///< the value alone, simple acceptance (JCGM 106:2012, 8.2)
  kGuardU,    ///< U = k u on either side of each limit is uncertain, as ISO 14253-1:1998 had it (there with k = 2)
};

struct DecisionSettings {
  DecisionRule rule = DecisionRule::kIso14253;
  double probability = 0.95;  ///< 0.5 < probability < 1
};

struct Decision {
  Verdict verdict = Verdict::kInvalid;
  /// That the true value lies within the limits: Student's t about the value. Absent without a value or uncertainty.
  std::optional<double> conformity;
  /// u is more than a third of upper - lower: a warning. False where one of the limits is open.
  bool u_above_third_of_tolerance = false;
  /// Below the noise floor, so that a lower limit cannot be shown to be kept.
  bool held_back_below_noise = false;
};

/// kInvalid without a value. Without limits kPass. Without an uncertainty kUncertain, except by kSimple. below_noise:
/// of a texture value below the noise floor; a pass by a lower limit becomes kUncertain. context: pure.
[[nodiscard]] Decision decide(std::optional<double> value, const std::optional<CombinedUncertainty>& uncertainty,
                              const Limits& limits, const DecisionSettings& settings = {}, bool below_noise = false);

/// Two-sided probability that a quantity known as value, u and degrees of freedom lies within the limits. u >= 0.
[[nodiscard]] double conformity_probability(double value, double u, double dof, const Limits& limits);

}  // namespace fvd::metrology
