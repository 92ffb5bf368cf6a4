#include "core/metrology/areal/autocorrelation.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/metrology/real_fft.hpp"

namespace fvd::metrology {
namespace {

constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();
constexpr std::int64_t kPairsShare = 4;  // lags with under one in so many of the pairs have no value

/// The greatest lag along an axis that can have a quarter of the pairs, by the points in each of its columns (or rows):
/// a pair needs one point that far from the one side and one that far from the other.
int greatest_lag(const std::vector<std::int64_t>& counts, std::int64_t points) {
  std::int64_t before = points;
  std::int64_t behind = points;
  std::size_t lag = 0;
  while (lag + 1 < counts.size()) {
    before -= counts[counts.size() - 1 - lag];
    behind -= counts[lag];
    if (kPairsShare * std::min(before, behind) < points) break;
    ++lag;
  }
  return static_cast<int>(lag);
}

/// Writes value(z) for every valid point, 0 elsewhere, and replaces the plane by its circular autocorrelation.
template <typename Value>
void correlate(const RegionHeights& heights, int fft_width, RealFft& fft, Value&& value) {
  const std::span<double> plane = fft.plane();
  std::fill(plane.begin(), plane.end(), 0.0);
  for (int y = 0; y < heights.height; ++y) {
    const double* z = heights.row(y);
    double* to = plane.data() + static_cast<std::ptrdiff_t>(y) * fft_width;
    for (int x = 0; x < heights.width; ++x) to[x] = std::isnan(z[x]) ? 0.0 : value(z[x]);
  }
  fft.forward();
  for (std::complex<double>& bin : fft.spectrum()) bin = std::norm(bin);
  fft.inverse();
}

/// Weights of the cubic through the values at -1, 0, 1, 2 (Lagrange).
std::array<double, 4> cubic_weights(double t) {
  return {-t * (t - 1.0) * (t - 2.0) / 6.0, (t + 1.0) * (t - 1.0) * (t - 2.0) / 2.0, -(t + 1.0) * t * (t - 2.0) / 2.0,
          (t + 1.0) * t * (t - 1.0) / 6.0};
}

}  // namespace

Autocorrelation::Autocorrelation(const RegionHeights& heights, double mean_um)
    : pitch_x_um_(heights.pitch_x_um), pitch_y_um_(heights.pitch_y_um) {
  assert(heights.points > 0);
  limit_lags(heights);
  fft_width_ = RealFft::good_size(heights.width + max_lag_x_);
  fft_height_ = RealFft::good_size(heights.height + max_lag_y_);
  values_ = Plane<double>(2 * (max_lag_x_ + kBeside) + 1, kBelow + max_lag_y_ + 1 + kBeside, kNoValue);
  RealFft fft(fft_width_, fft_height_);
  correlate(heights, fft_width_, fft, [&](double z_um) { return z_um - mean_um; });
  const std::span<const double> sums = fft.plane();
  const double square_sum = sums[0];
  assert(square_sum > 0.0);
  for (int lag_y = 0; lag_y <= max_lag_y_; ++lag_y) {
    const double* row = sums.data() + static_cast<std::ptrdiff_t>(lag_y) * fft_width_;
    for (int lag_x = -max_lag_x_; lag_x <= max_lag_x_; ++lag_x) {
      *entry(lag_x, lag_y) = row[lag_x < 0 ? lag_x + fft_width_ : lag_x];
    }
  }
  divide_by_pairs(heights, square_sum, fft);
  turn_rows();
}

void Autocorrelation::limit_lags(const RegionHeights& heights) {
  std::vector<std::int64_t> columns(static_cast<std::size_t>(heights.width));
  std::vector<std::int64_t> rows(static_cast<std::size_t>(heights.height));
  for (int y = 0; y < heights.height; ++y) {
    const double* z = heights.row(y);
    for (int x = 0; x < heights.width; ++x) {
      const int valid = std::isnan(z[x]) ? 0 : 1;
      columns[static_cast<std::size_t>(x)] += valid;
      rows[static_cast<std::size_t>(y)] += valid;
    }
  }
  max_lag_x_ = greatest_lag(columns, static_cast<std::int64_t>(heights.points));
  max_lag_y_ = greatest_lag(rows, static_cast<std::int64_t>(heights.points));
}

void Autocorrelation::divide_by_pairs(const RegionHeights& heights, double square_sum, RealFft& fft) {
  const auto points = static_cast<std::int64_t>(heights.points);
  const bool full = points == std::int64_t{heights.width} * heights.height;
  if (!full) correlate(heights, fft_width_, fft, [](double) { return 1.0; });
  const std::span<const double> sums = fft.plane();
  const double scale = static_cast<double>(points) / square_sum;
  for (int lag_y = 0; lag_y <= max_lag_y_; ++lag_y) {
    const double* row = sums.data() + static_cast<std::ptrdiff_t>(lag_y) * fft_width_;
    for (int lag_x = -max_lag_x_; lag_x <= max_lag_x_; ++lag_x) {
      const std::int64_t pairs = full ? std::int64_t{heights.width - std::abs(lag_x)} * (heights.height - lag_y)
                                      : std::llround(row[lag_x < 0 ? lag_x + fft_width_ : lag_x]);
      double& value = *entry(lag_x, lag_y);
      value = kPairsShare * pairs < points ? kNoValue : value * scale / static_cast<double>(pairs);
    }
  }
}

void Autocorrelation::turn_rows() {
  for (int lag_y = 1; lag_y <= std::min(kBelow, max_lag_y_); ++lag_y) {
    for (int lag_x = -max_lag_x_; lag_x <= max_lag_x_; ++lag_x) *entry(-lag_x, -lag_y) = *entry(lag_x, lag_y);
  }
}

std::optional<double> Autocorrelation::at(int lag_x, int lag_y) const {
  if (lag_y < 0) return at(-lag_x, -lag_y);
  if (std::abs(lag_x) > max_lag_x_ || lag_y > max_lag_y_) return std::nullopt;
  const double value = *entry(lag_x, lag_y);
  return std::isnan(value) ? std::nullopt : std::optional<double>(value);
}

std::optional<double> Autocorrelation::at_um(double lag_x_um, double lag_y_um) const {
  if (lag_y_um < 0.0) return at_um(-lag_x_um, -lag_y_um);
  const double x = lag_x_um / pitch_x_um_;
  const double y = lag_y_um / pitch_y_um_;
  if (std::abs(x) > max_lag_x_ || y > max_lag_y_) return std::nullopt;
  const double left = std::floor(x);
  const double top = std::floor(y);
  const auto wx = cubic_weights(x - left);
  const auto wy = cubic_weights(y - top);
  // The margins of the plane hold every neighbour that is read here.
  const double* const corner = entry(static_cast<int>(left), static_cast<int>(top));
  const std::ptrdiff_t stride = values_.width();
  double cubic = 0.0;
  for (int j = 0; j < 4; ++j) {
    const double* row = corner + (j - 1) * stride;
    cubic += wy[static_cast<std::size_t>(j)] * (wx[0] * row[-1] + wx[1] * row[0] + wx[2] * row[1] + wx[3] * row[2]);
  }
  if (!std::isnan(cubic)) return cubic;
  const double tx = x - left;
  const double ty = y - top;
  const double linear = (1.0 - ty) * ((1.0 - tx) * corner[0] + tx * corner[1]) +
                        ty * ((1.0 - tx) * corner[stride] + tx * corner[stride + 1]);
  return std::isnan(linear) ? std::nullopt : std::optional<double>(linear);
}

}  // namespace fvd::metrology
