#pragma once

/// Sums over the heights of a part of a profile.

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace fvd::metrology {

/// Of the points that are not holes.
struct HeightSums {
  std::size_t points = 0;
  double mean_absolute_um = 0.0;  ///< Ra; ISO 21920-2:2021
  double root_mean_square_um = 0.0;
  double cubes = 0.0;       ///< mean z^3 / root_mean_square_um^3; 0 for a flat profile
  double fourths = 0.0;     ///< mean z^4 / root_mean_square_um^4
  double highest_um = 0.0;  ///< above the line; negative where all is below
  double deepest_um = 0.0;  ///< below the line
};
[[nodiscard]] HeightSums sum_heights(std::span<const double> z_um);

/// The longest run of holes, in points.
[[nodiscard]] std::size_t longest_hole(std::span<const double> z_um);

/// The heights less their least squares line; holes stay. Under two points: less their mean.
[[nodiscard]] std::vector<double> less_line(std::span<const double> z_um);

/// The heights less their mean; holes stay.
[[nodiscard]] std::vector<double> less_mean(std::span<const double> z_um);

/// Root mean square of the slope by central differences of 7 points, beside holes and ends of 5 or 3; absent where no
/// point has both neighbours. ISO 21920-2:2021 (7 points); the shorter ones: own definition.
[[nodiscard]] std::optional<double> root_mean_square_slope(std::span<const double> z_um, double pitch_um);

}  // namespace fvd::metrology
