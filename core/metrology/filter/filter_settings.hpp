#pragma once

/// What a filter shall do and what it tells about itself, for surfaces and for profiles.

#include <cstddef>
#include <optional>
#include <string_view>

namespace fvd::metrology {

enum class FilterSide {
  kS,  ///< gives the smooth surface: short wavelengths are taken away
  kL,  ///< gives the rest: long wavelengths are taken away
};

enum class FilterMethod {
  kGaussian,             ///< ISO 16610-21, -61: mean of the valid points, weighted by the Gaussian
  kGaussianRegression1,  ///< ISO 16610-31, -71, p = 1: local plane; inside, what kGaussian is
  kGaussianRegression2,  ///< ISO 16610-31, -71, p = 2: local paraboloid
};

/// "S" or "L".
[[nodiscard]] std::string_view filter_side_name(FilterSide side) noexcept;
[[nodiscard]] std::optional<FilterSide> filter_side_from_name(std::string_view name) noexcept;
/// "gaussian", "gaussian_regression_1" or "gaussian_regression_2".
[[nodiscard]] std::string_view filter_method_name(FilterMethod method) noexcept;
[[nodiscard]] std::optional<FilterMethod> filter_method_from_name(std::string_view name) noexcept;

/// Below this many pixels a nesting index is refused: there a sampled Gaussian is no longer right to 0.001.
inline constexpr double kMinNestingPx = 5.0;
/// Tukey's cut in medians of the absolute residuals (ISO 16610-31: 3 standard deviations, 3 * 1.4826).
inline constexpr double kTukeyCut = 4.4478;
/// Rounds of a robust filter end where the cut changed by less than this share of itself.
inline constexpr double kRobustChange = 1e-4;
inline constexpr int kMaxRobustRounds = 20;
/// kGaussian gives a point only where at least this share of the kernel's weight lies on valid points.
inline constexpr double kMinWeightShare = 0.5;
/// The same for the regressions, which need no symmetry: the corner of a field holds a quarter. Own definition.
inline constexpr double kMinRegressionWeightShare = 0.05;

struct FilterSettings {
  FilterSide side = FilterSide::kS;
  double nesting_um = 0.0;
  FilterMethod method = FilterMethod::kGaussian;
  bool robust = false;
  /// kGaussian on the L side takes away a margin of nesting_um / 2 along the borders of the field, unless this is set.
  bool keep_margin = false;
  /// What border_error_um is compared with; absent: the median standard error of the field, if it has one.
  std::optional<double> noise_floor_um = std::nullopt;
};

struct FilterReport {
  double nesting_px_x = 0.0;
  double nesting_px_y = 0.0;     ///< 0 for a profile
  int rounds = 1;                ///< fits made; 1 where not robust
  bool converged = true;         ///< false where kMaxRobustRounds did not do
  std::optional<double> cut_um;  ///< of the last robust round
  std::size_t points_in = 0;     ///< valid points before
  std::size_t points_lost = 0;   ///< of them, holes after: too little weight beside them, or in the margin
  double margin_um = 0.0;        ///< taken away along each border of the field
  /// The most by which the general slope (order 0) or curvature (order 1) of the field, which a paraboloid through all
  /// its points tells, moves the smooth surface where the kernel is cut by a border or hole: for order 0
  /// slope * s * phi(q) / p with s the kernel's standard deviation, p the smallest share of valid weight beside a point
  /// that is given, and q its normal quantile; 0.1495 * nesting * slope for p = 1/2. For order 1 at a straight border
  /// curvature / 2 * s^2 (4 / pi - 1) / (1 - 2 / pi). 0 for order 2. Own definition.
  double border_error_um = 0.0;
  std::optional<double> noise_floor_um;  ///< compared with; absent = nothing to compare with
  bool border_error_above_noise = false;
};

}  // namespace fvd::metrology
