#pragma once

/// Repeatability and reproducibility of a gauge: parts x operators x trials, analysis of variance.

#include <optional>
#include <span>

namespace fvd::metrology {

struct GaugeRrSettings {
  int parts = 0;                    ///< 2 or more
  int operators = 0;                ///< 1 or more; with one there is no reproducibility
  int trials = 0;                   ///< 2 or more
  double pooling_p = 0.25;          ///< above it the interaction is pooled with the repeatability
  std::optional<double> tolerance;  ///< T, > 0
  double spread_sd = 6.0;           ///< width of a spread in standard deviations, against the tolerance
};

/// Standard deviations, in the unit of the values.
struct GaugeRr {
  double ev = 0.0;           ///< repeatability
  double av = 0.0;           ///< reproducibility between operators
  double interaction = 0.0;  ///< parts x operators, 0 where pooled
  double grr = 0.0;          ///< root of the sum of the three squares
  double pv = 0.0;           ///< part to part
  double tv = 0.0;           ///< total
  bool interaction_pooled = false;
  std::optional<double> interaction_p;             ///< of the F test; absent with one operator
  std::optional<double> grr_of_total_percent;      ///< 100 GRR / TV; absent where TV is 0
  std::optional<double> grr_of_tolerance_percent;  ///< 100 spread GRR / T
  std::optional<int> ndc;  ///< number of distinct categories, 1.41 PV / GRR cut to an integer; absent where GRR is 0
};

/// Two-way ANOVA with random effects, AIAG MSA 4th edition, chapter III B; negative variance components are 0.
/// values: part-major, then operator, then trial: values[(part * operators + operator) * trials + trial].
/// Throws Error(kBadInput) for another number of values or a setting out of range. context: pure.
[[nodiscard]] GaugeRr gauge_rr(std::span<const double> values, const GaugeRrSettings& settings);

}  // namespace fvd::metrology
