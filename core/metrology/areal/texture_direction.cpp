#include "core/metrology/areal/texture_direction.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>
#include <numeric>
#include <span>
#include <vector>

#include "core/metrology/real_fft.hpp"

namespace fvd::metrology {
namespace {

constexpr int kMinPixels = 8;
constexpr int kBins = 360;  // of half a turn
constexpr double kBinsPerRad = kBins / std::numbers::pi;
constexpr double kSamePeak = 1e-6;
constexpr double kPeakShare = 0.5;
constexpr double kStandsOut = 2.0;  // so many times the mean power must the greatest have
constexpr int kPeaksApart = 4;      // bins; nearer ones are one peak

using Angles = std::array<double, kBins>;  // bin i: lay from i to i + 1 half degrees

std::size_t wrapped(int bin) { return static_cast<std::size_t>(((bin % kBins) + kBins) % kBins); }

std::vector<double> hann(int size) {
  std::vector<double> weights(static_cast<std::size_t>(size));
  for (int i = 0; i < size; ++i) {
    const double wave = std::sin(std::numbers::pi * (i + 0.5) / size);
    weights[static_cast<std::size_t>(i)] = wave * wave;
  }
  return weights;
}

/// Writes the windowed heights into the plane of the transform.
void window(const RegionHeights& heights, int fft_width, std::span<double> plane) {
  const std::vector<double> along_x = hann(heights.width);
  const std::vector<double> along_y = hann(heights.height);
  double weighted = 0.0;
  double weights = 0.0;
  for (int y = 0; y < heights.height; ++y) {
    const double* z = heights.row(y);
    double row_weighted = 0.0;
    double row_weights = 0.0;
    for (int x = 0; x < heights.width; ++x) {
      const double weight = std::isnan(z[x]) ? 0.0 : along_x[static_cast<std::size_t>(x)];
      row_weights += weight;
      row_weighted += weight == 0.0 ? 0.0 : weight * z[x];
    }
    weighted += along_y[static_cast<std::size_t>(y)] * row_weighted;
    weights += along_y[static_cast<std::size_t>(y)] * row_weights;
  }
  const double mean_um = weighted / weights;
  std::fill(plane.begin(), plane.end(), 0.0);
  for (int y = 0; y < heights.height; ++y) {
    const double* z = heights.row(y);
    double* to = plane.data() + static_cast<std::ptrdiff_t>(y) * fft_width;
    const double weight_y = along_y[static_cast<std::size_t>(y)];
    for (int x = 0; x < heights.width; ++x) {
      to[x] = std::isnan(z[x]) ? 0.0 : weight_y * along_x[static_cast<std::size_t>(x)] * (z[x] - mean_um);
    }
  }
}

/// Adds power to the bins between two angles, in bins, by the share of each.
void spread(Angles& angles, double from, double to, double power) {
  const double density = power / (to - from);
  for (int bin = static_cast<int>(std::floor(from)); bin < to; ++bin) {
    const double share = std::min(to, bin + 1.0) - std::max(from, static_cast<double>(bin));
    angles[wrapped(bin)] += share * density;
  }
}

Angles angular_power(const RegionHeights& heights) {
  const int width = RealFft::good_size(heights.width);
  const int height = RealFft::good_size(heights.height);
  RealFft fft(width, height);
  window(heights, width, fft.plane());
  fft.forward();
  const double step_x = 1.0 / (width * heights.pitch_x_um);
  const double step_y = 1.0 / (height * heights.pitch_y_um);
  const double nyquist = 0.5 / std::max(heights.pitch_x_um, heights.pitch_y_um);
  const std::span<const std::complex<double>> spectrum = fft.spectrum();
  Angles angles{};
  for (int v = 0; v < height; ++v) {
    const double frequency_y = step_y * (v <= height / 2 ? v : v - height);
    const std::complex<double>* row = spectrum.data() + static_cast<std::ptrdiff_t>(v) * (width / 2 + 1);
    for (int u = 0; u <= width / 2; ++u) {
      const double frequency_x = step_x * u;
      const double frequency = std::sqrt(frequency_x * frequency_x + frequency_y * frequency_y);
      if (frequency == 0.0 || frequency > nyquist) continue;
      // A bin stands for its opposite too, except in the columns that hold both.
      const double power = std::norm(row[u]) * (u == 0 || 2 * u == width ? 0.5 : 1.0);
      const double lay = std::atan2(frequency_x, frequency_y) * kBinsPerRad;
      const double cell = (step_x * std::abs(frequency_y) + step_y * frequency_x) / frequency;
      const double half = std::min(0.5 * cell / frequency * kBinsPerRad, 0.5 * kBins);
      spread(angles, lay - half, lay + half, power);
    }
  }
  return angles;
}

bool is_peak(const Angles& angles, int bin) {
  for (int offset = -kPeaksApart; offset <= kPeaksApart; ++offset) {
    if (angles[wrapped(bin + offset)] > angles[wrapped(bin)]) return false;
  }
  return true;
}

/// The mean direction of the bins around a peak that are above half of it.
double peak_deg(const Angles& angles, int peak) {
  const double limit = kPeakShare * angles[wrapped(peak)];
  double power = 0.0;
  double moment = 0.0;
  const auto take = [&](int bin) {
    power += angles[wrapped(bin)];
    moment += angles[wrapped(bin)] * (bin - peak);
  };
  take(peak);
  for (int bin = peak + 1; bin < peak + kBins / 2 && angles[wrapped(bin)] > limit; ++bin) take(bin);
  for (int bin = peak - 1; bin > peak - kBins / 2 && angles[wrapped(bin)] > limit; --bin) take(bin);
  const double deg = (peak + 0.5 + moment / power) * 180.0 / kBins;
  return std::fmod(deg + 180.0, 180.0);
}

}  // namespace

ArealValue texture_direction_deg(const RegionHeights& heights) {
  if (heights.width < kMinPixels || heights.height < kMinPixels) {
    return ArealValue::none("the region has fewer than 8 columns or rows");
  }
  const Angles angles = angular_power(heights);
  const double greatest = *std::max_element(angles.begin(), angles.end());
  if (!(greatest > 0.0)) return ArealValue::none("the surface has no waves");
  if (greatest * kBins < kStandsOut * std::accumulate(angles.begin(), angles.end(), 0.0)) {
    return ArealValue::none("no direction has twice the mean power of all directions");
  }
  std::vector<double> peaks_deg;
  int last = -kBins;
  int first = 0;
  for (int bin = 0; bin < kBins; ++bin) {
    if (angles[wrapped(bin)] < greatest * (1.0 - kSamePeak) || !is_peak(angles, bin)) continue;
    const bool new_peak = bin - last > kPeaksApart && (peaks_deg.empty() || first + kBins - bin > kPeaksApart);
    if (peaks_deg.empty()) first = bin;
    last = bin;
    if (new_peak) peaks_deg.push_back(peak_deg(angles, bin));
  }
  return ArealValue::of(*std::min_element(peaks_deg.begin(), peaks_deg.end()), peaks_deg.size() > 1);
}

}  // namespace fvd::metrology
