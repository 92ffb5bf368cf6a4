#pragma once

/// Means, moments and extremes of heights: the same bytes in whatever order the points stand.

#include <span>

namespace fvd::metrology {

/// At least one height.
[[nodiscard]] double mean_height_um(std::span<const double> heights_um);

/// Sa Sq Ssk Sku Sp Sv Sz of ISO 25178-2:2021, or Pa Pq Psk Pku Pp Pv Pt of ISO 21920-2:2021.
struct HeightMoments {
  double mean_absolute_um = 0.0;
  double root_mean_square_um = 0.0;
  double skewness = 0.0;  ///< 0 where every height is 0
  double kurtosis = 0.0;  ///< 0 where every height is 0
  double peak_um = 0.0;
  double pit_um = 0.0;  ///< positive
  [[nodiscard]] double total_um() const { return peak_um + pit_um; }
};

/// heights_um: at least one height, about the mean.
[[nodiscard]] HeightMoments height_moments(std::span<const double> heights_um);

}  // namespace fvd::metrology
