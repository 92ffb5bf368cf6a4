#pragma once

/// The budget of a value's uncertainty, and what follows from it.

#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace fvd::metrology {

inline constexpr double kInfiniteDof = std::numeric_limits<double>::infinity();

enum class UncertaintyType {
  kA,  ///< by statistics of observations
  kB,  ///< by other means
};

struct BudgetEntry {
  std::string source;           ///< "noise", "slice_z", "alpha_z", ...
  std::optional<double> value;  ///< of the quantity, in its own unit, where it has one
  double sensitivity = 1.0;     ///< unit of the result per unit of the quantity
  double u = 0.0;               ///< standard uncertainty of the quantity, in its own unit; >= 0
  UncertaintyType type = UncertaintyType::kB;
  double dof = kInfiniteDof;            ///< > 0
  std::optional<double> points_as_one;  ///< of noise: see LinearNoise

  /// What it contributes to the result, in its unit.
  [[nodiscard]] double contribution() const { return (sensitivity < 0.0 ? -sensitivity : sensitivity) * u; }
};

struct Budget {
  std::vector<BudgetEntry> entries;
  std::vector<std::string> not_evaluated;  ///< sources of which nothing is known; they are not in u
};

struct CombinedUncertainty {
  double u = 0.0;             ///< root of the sum of the squared contributions, GUM 5.1.2
  double dof = kInfiniteDof;  ///< effective, Welch and Satterthwaite, GUM G.4.1 (not rounded)
  double k = 0.0;             ///< quantile of Student's t, two-sided, GUM G.3.2
  double expanded = 0.0;      ///< U = k u
  double coverage = 0.95;     ///< probability for which k is chosen
};

/// Absent where the budget has no entry: nothing is known then, which is not an uncertainty of 0.
/// 0 < coverage < 1. context: pure, as the next ones.
[[nodiscard]] std::optional<CombinedUncertainty> combined(const Budget& budget, double coverage = 0.95);

/// Quantile of Student's t that `coverage` of the distribution lies within on both sides; of the normal distribution
/// for infinitely many degrees of freedom.
[[nodiscard]] double coverage_factor(double dof, double coverage);

/// Errors of the slices' measured z, which all points of a plateau share and which do not average over them.
/// sensitivities[j]: change of the value per um of slice j's z, mean over the region; u_um[j]: standard uncertainty of
/// that z. Independent between slices: u = sqrt(sum of (s_j u_j)^2). Of equal lengths. Type B, own definition.
[[nodiscard]] BudgetEntry slice_z_entry(std::span<const double> sensitivities, std::span<const double> u_um);

/// Standard uncertainty of a slice's z from the scatter of its measured positions and the resolution of the encoder:
/// sqrt(sd^2 + resolution^2 / 12). Both >= 0.
[[nodiscard]] double slice_z_uncertainty_um(double measured_sd_um, double encoder_resolution_um);

}  // namespace fvd::metrology
