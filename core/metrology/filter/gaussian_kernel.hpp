#pragma once

/// The Gaussian of ISO 16610: its width for each method, its transmission, and its samples.

#include <vector>

#include "core/metrology/filter/filter_settings.hpp"

namespace fvd::metrology {

/// exp(-pi (x / (width * nesting))^2) with width = sqrt(ln 2 / pi) for the mean and the local plane (ISO 16610-21,
/// -61), for which half of a wave of one nesting index passes, and 0.7309 for the local paraboloid, for which the same
/// holds (ISO 16610-31: the root of (1 + u) exp(-u) = 1/2, u = pi width^2).
[[nodiscard]] double gaussian_width(FilterMethod method) noexcept;

/// The Gaussian's standard deviation, gaussian_width() * nesting / sqrt(2 pi), in the unit of nesting.
[[nodiscard]] double gaussian_deviation(FilterMethod method, double nesting) noexcept;

/// The share of a wave's amplitude that the smooth surface keeps, far from borders: 2^-(n^2), for the local paraboloid
/// (1 + u) exp(-u), with n = nesting / wavelength, u = pi (width n)^2. Surfaces in two directions: n^2 = n_x^2 + n_y^2.
[[nodiscard]] double filter_transmission(FilterMethod method, double nesting_over_wavelength) noexcept;

/// Samples at the distances 0, 1, ... reach pixels; the kernel is symmetric, and 1 at 0 (not scaled to a sum).
struct SampledGaussian {
  std::vector<double> weights;
  double deviation_px = 0.0;

  [[nodiscard]] int reach_px() const { return static_cast<int>(weights.size()) - 1; }
  [[nodiscard]] double sum() const;  ///< over both sides
};

/// In nesting indices, for the width of the mean; order 2 reaches as many of its deviations. 0.5 would err by 1.1 %.
inline constexpr double kUsualSupport = 1.1;   ///< weights beyond are below 4e-8 of the middle
inline constexpr double kWholeSupport = 1.55;  ///< below 2e-15: the transform of the kernel ends, too

/// support >= 0.75, see above; nesting_px > 0.
[[nodiscard]] SampledGaussian sample_gaussian(FilterMethod method, double nesting_px, double support = kUsualSupport);

}  // namespace fvd::metrology
