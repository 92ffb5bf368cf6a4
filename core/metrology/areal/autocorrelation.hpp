#pragma once

/// The areal autocorrelation function of a region, and how far it reaches.

#include <optional>
#include <string>
#include <utility>

#include "core/metrology/areal/region_heights.hpp"

namespace fvd::metrology {

class RealFft;

/// fACF(tx, ty) of ISO 25178-2:2021 for points with holes: the mean of z z' over the pairs of valid points at the lag,
/// over the mean of z^2 over all valid points. Lags with less than a quarter of the pairs of lag 0 have no value.
class Autocorrelation {
 public:
  /// heights: at least one valid point, heights not all equal to the mean. Cost: four Fourier transforms of three times
  /// the region, two where it is a rectangle without holes.
  Autocorrelation(const RegionHeights& heights, double mean_um);

  /// At a lag in pixels; absent where it has too few pairs.
  [[nodiscard]] std::optional<double> at(int lag_x, int lag_y) const;
  /// Between lags: the cubic through 4 x 4 lags, or linear where some of these have no value; absent where one of the
  /// 2 x 2 around has none.
  [[nodiscard]] std::optional<double> at_um(double lag_x_um, double lag_y_um) const;
  /// The distance from lag 0 in a direction, from x towards y, at which it first falls to the threshold; absent where
  /// it does not within the lags that have values.
  [[nodiscard]] std::optional<double> fall_um(double direction_rad, double threshold) const;

  [[nodiscard]] int max_lag_x() const { return max_lag_x_; }
  [[nodiscard]] int max_lag_y() const { return max_lag_y_; }

 private:
  /// Rows for lags of y from -kBelow on; those of negative y are the others turned by half a turn.
  static constexpr int kBelow = 1;
  static constexpr int kBeside = 2;

  [[nodiscard]] double* entry(int lag_x, int lag_y) {
    return values_.row(lag_y + kBelow) + (lag_x + max_lag_x_ + kBeside);
  }
  [[nodiscard]] const double* entry(int lag_x, int lag_y) const {
    return values_.row(lag_y + kBelow) + (lag_x + max_lag_x_ + kBeside);
  }
  void limit_lags(const RegionHeights& heights);
  void divide_by_pairs(const RegionHeights& heights, double square_sum, RealFft& fft);
  void turn_rows();

  double pitch_x_um_;
  double pitch_y_um_;
  int max_lag_x_ = 0;
  int max_lag_y_ = 0;
  int fft_width_ = 0;
  int fft_height_ = 0;
  Plane<double> values_;  ///< NaN = no value
};

/// What Sal and Str are made of.
struct AutocorrelationLengths {
  double shortest_um = 0.0;  ///< Sal
  double longest_um = 0.0;   ///< Str = shortest / longest
};

/// ISO 25178-2:2021 Sal, Str: the shortest and the longest distance at which the function falls to the threshold. Own
/// definition of the search: 720 directions of half a turn, the extreme ones refined between their neighbours; along a
/// direction steps of half the smaller pitch. Absent, with a reason, where it does not fall to it in some direction.
[[nodiscard]] std::pair<std::optional<AutocorrelationLengths>, std::string> autocorrelation_lengths(
    const Autocorrelation& function, double threshold);

}  // namespace fvd::metrology
