#pragma once

/// Medians and robust straight or bent lines.

#include <span>
#include <vector>

namespace fvd::metrology::edge {

/// A standard deviation from a median absolute deviation, for a normal distribution.
inline constexpr double kSdPerMad = 1.4826;

/// p in 0..1, linear between order statistics (ISO 16269-4 style, position p (n - 1)). values: not empty.
[[nodiscard]] double quantile(std::vector<double> values, double p);
[[nodiscard]] inline double median(std::vector<double> values) { return quantile(std::move(values), 0.5); }
/// 1.4826 x the median of |value - median|.
[[nodiscard]] double robust_sd(std::vector<double> values);

/// A polynomial in t = (x - centre) / half, so that its coefficients stay of one size.
struct Polynomial {
  double centre = 0.0;
  double half = 1.0;
  std::vector<double> coefficients{0.0};

  [[nodiscard]] double operator()(double x) const;
  [[nodiscard]] double slope(double x) const;
};

/// Tukey's weights, cut at 4.685 robust standard deviations of the residuals, started from least absolute residuals.
/// x, y, weights: of one size, at least degree + 1; empty weights = all 1.
[[nodiscard]] Polynomial robust_polynomial(std::span<const double> x, std::span<const double> y, int degree,
                                           std::span<const double> weights = {});

}  // namespace fvd::metrology::edge
