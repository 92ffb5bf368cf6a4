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
constexpr double kMaxReachRad = std::numbers::pi / 4.0;
constexpr int kPeaksApart = 4;  // bins; nearer ones are one peak

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

/// The power spectrum of the windowed heights.
class PowerSpectrum {
 public:
  explicit PowerSpectrum(const RegionHeights& heights)
      : width_(RealFft::good_size(heights.width)),
        height_(RealFft::good_size(heights.height)),
        step_x_(1.0 / (width_ * heights.pitch_x_um)),
        step_y_(1.0 / (height_ * heights.pitch_y_um)),
        nyquist_(0.5 / std::max(heights.pitch_x_um, heights.pitch_y_um)),
        fft_(width_, height_) {
    window(heights, width_, fft_.plane());
    fft_.forward();
  }

  [[nodiscard]] double step_x() const { return step_x_; }
  [[nodiscard]] double step_y() const { return step_y_; }

  /// Calls visit(frequency_x, frequency_y, power) for the waves of half a turn, frequency_x >= 0, in 1/um.
  template <typename Visit>
  void for_each_wave(Visit&& visit) {
    const std::span<const std::complex<double>> spectrum = fft_.spectrum();
    for (int v = 0; v < height_; ++v) {
      const double frequency_y = step_y_ * (v <= height_ / 2 ? v : v - height_);
      const std::complex<double>* row = spectrum.data() + static_cast<std::ptrdiff_t>(v) * (width_ / 2 + 1);
      for (int u = 0; u <= width_ / 2; ++u) {
        const double frequency_x = step_x_ * u;
        const double square = frequency_x * frequency_x + frequency_y * frequency_y;
        if (square == 0.0 || square > nyquist_ * nyquist_) continue;
        // A bin stands for its opposite too, except in the columns that hold both.
        visit(frequency_x, frequency_y, std::norm(row[u]) * (u == 0 || 2 * u == width_ ? 0.5 : 1.0));
      }
    }
  }

 private:
  int width_;
  int height_;
  double step_x_;
  double step_y_;
  double nyquist_;
  RealFft fft_;
};

Angles angular_power(PowerSpectrum& spectrum) {
  Angles angles{};
  spectrum.for_each_wave([&](double frequency_x, double frequency_y, double power) {
    const double square = frequency_x * frequency_x + frequency_y * frequency_y;
    const double lay = std::atan2(frequency_x, frequency_y) * kBinsPerRad;
    const double cell_rad = (spectrum.step_x() * std::abs(frequency_y) + spectrum.step_y() * frequency_x) / square;
    const double half = std::min(0.5 * cell_rad * kBinsPerRad, 0.5 * kBins);
    spread(angles, lay - half, lay + half, power);
  });
  return angles;
}

bool is_peak(const Angles& angles, int bin) {
  for (int offset = -kPeaksApart; offset <= kPeaksApart; ++offset) {
    if (angles[wrapped(bin + offset)] > angles[wrapped(bin)]) return false;
  }
  return true;
}

/// The lay across the mean wave of a peak: of the waves that are as far from its middle as twice the width of the
/// bins above half of the peak, so that a Hann window's whole line is in. The mean of a Hann window's bins is where a
/// wave between the bins is.
double peak_deg(PowerSpectrum& spectrum, const Angles& angles, int peak) {
  const double limit = kPeakShare * angles[wrapped(peak)];
  int first = peak;
  int last = peak;
  while (last - peak < kBins / 2 && angles[wrapped(last + 1)] > limit) ++last;
  while (peak - first < kBins / 2 && angles[wrapped(first - 1)] > limit) --first;
  const double middle_rad = 0.5 * (first + last + 1) / kBinsPerRad;
  const double reach_rad = std::min(2.0 * (last - first + 1) / kBinsPerRad, kMaxReachRad);
  const double across_x = std::sin(middle_rad);
  const double across_y = std::cos(middle_rad);
  const double slope = std::tan(reach_rad);
  double along = 0.0;
  double aside = 0.0;
  spectrum.for_each_wave([&](double frequency_x, double frequency_y, double power) {
    const double forward = frequency_x * across_x + frequency_y * across_y;
    const double sideways = frequency_x * across_y - frequency_y * across_x;
    if (std::abs(sideways) > slope * std::abs(forward)) return;
    along += power * std::abs(forward);
    aside += forward < 0.0 ? -power * sideways : power * sideways;
  });
  const double deg = (middle_rad + std::atan2(aside, along)) * 180.0 / std::numbers::pi;
  return std::fmod(deg + 360.0, 180.0);
}

}  // namespace

ArealValue texture_direction_deg(const RegionHeights& heights) {
  if (heights.width < kMinPixels || heights.height < kMinPixels) {
    return ArealValue::none("the region has fewer than 8 columns or rows");
  }
  PowerSpectrum spectrum(heights);
  const Angles angles = angular_power(spectrum);
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
    if (new_peak) peaks_deg.push_back(peak_deg(spectrum, angles, bin));
  }
  return ArealValue::of(*std::min_element(peaks_deg.begin(), peaks_deg.end()), peaks_deg.size() > 1);
}

}  // namespace fvd::metrology
