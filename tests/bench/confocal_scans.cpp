#include "tests/bench/confocal_scans.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

#include "core/focus/streaming_focus_stack.hpp"
#include "core/image/image.hpp"
#include "core/runtime/worker_pool.hpp"

namespace fvd::bench {

namespace {

constexpr int kWidth_px = 256;
constexpr int kHeight_px = 96;
constexpr double kReach_widths = 3.0;
constexpr double kBackground = 0.015;  // shares of the peak
constexpr double kNoise = 0.01;
constexpr double kPeak_grey = 50000.0;
constexpr double kHalf = 1.39155737825151;  // sin(x)^2 / x^2 is one half there

double intensity(double away_widths) {
  const double x = 2.0 * kHalf * away_widths;
  return x == 0.0 ? 1.0 : std::pow(std::sin(x) / x, 2);
}

double slope(double away_widths) {
  constexpr double kApart = 1e-4;
  return (intensity(away_widths + kApart) - intensity(away_widths - kApart)) / (2.0 * kApart);
}

/// Passes many fractions of a sample.
double height_um(int x, int y) { return 1.3 * (x + 0.37 * y) / kWidth_px - 0.8; }

}  // namespace

ConfocalFigures scan_confocal(double step_widths, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  ConfocalFigures figures;
  FocusSettings settings{.focus_operator = FocusOperator::kIntensity, .window_px = 1};
  const int slices = static_cast<int>(2.0 * (kReach_widths + 1.0) / step_widths) + 1;
  settings.bin_slices = figures.bin_slices = choose_bin_slices(step_widths, 1.0, slices);
  WorkerPool pool(2);
  StreamingFocusStack stack(kWidth_px, kHeight_px, PixelFormat::kMono16, settings, pool);
  Plane<std::uint16_t> image(kWidth_px, kHeight_px);
  double information = 0.0;  // mean over the points of the sum of I'^2
  for (int k = 0; k < slices; ++k) {
    const double z_um = step_widths * k - kReach_widths - 1.0;
    for (int y = 0; y < kHeight_px; ++y) {
      for (int x = 0; x < kWidth_px; ++x) {
        const double away = z_um - height_um(x, y);
        const double share = intensity(away) + kBackground + kNoise * normal(random);
        image.row(y)[x] = static_cast<std::uint16_t>(std::lround(std::clamp(kPeak_grey * share, 0.0, 65000.0)));
        information += std::pow(slope(away), 2) / (kWidth_px * kHeight_px);
      }
    }
    stack.push(image_view(image.view(), PixelFormat::kMono16), z_um);
  }
  const HeightMap map = stack.finish(PeakMethod::kFiveSample);
  double squares = 0.0;
  double variances = 0.0;
  double points = 0.0;
  for (int y = 0; y < kHeight_px; ++y) {
    for (int x = 0; x < kWidth_px; ++x) {
      if (map.mask.row(y)[x] != 0) continue;
      squares += std::pow(1e6 * static_cast<double>(map.height_m.row(y)[x]) - height_um(x, y), 2);
      variances += std::pow(1e6 * static_cast<double>(map.sigma_m.row(y)[x]), 2);
      points += 1.0;
    }
  }
  figures.valid = points / (kWidth_px * kHeight_px);
  figures.over_bound = std::sqrt(squares / points) * std::sqrt(information) / kNoise;
  figures.sigma_over_rms = std::sqrt(variances / squares);
  figures.width_error = map.curve_width_um - 1.0;
  return figures;
}

}  // namespace fvd::bench
