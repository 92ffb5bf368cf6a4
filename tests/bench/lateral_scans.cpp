#include "tests/bench/lateral_scans.hpp"

#include <cmath>
#include <numbers>
#include <vector>

#include "core/focus/fit/smooth_heights.hpp"
#include "core/focus/streaming_focus_stack.hpp"
#include "sim/world/defocus_renderer.hpp"
#include "sim/world/texture.hpp"

namespace fvd::bench {

namespace {

constexpr int kWidth = 480;
constexpr int kHeight = 320;
constexpr double kAmplitude_um = 3.0;  // small against the curve's width of 38 um
constexpr double kStep_um = 10.0;
constexpr int kSlices = 17;
constexpr int kMargin_px = 40;

}  // namespace

double sine_transfer(const FocusSettings& settings, std::optional<double> smooth_px, double period_px,
                     WorkerPool& pool) {
  Plane<float> height_um(kWidth, kHeight);
  const auto phase = [&](int x) { return 2.0 * std::numbers::pi * x / period_px; };
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) height_um.at(x, y) = static_cast<float>(kAmplitude_um * std::sin(phase(x)));
  }
  const Plane<std::uint8_t> poor(kWidth, kHeight);
  const auto texture = sim::make_texture(sim::TextureKind::kWhite, poor, 30.0, 1.0, 7);
  sim::DefocusRenderer renderer(texture, height_um, {.readout_noise = 0.5});
  StreamingFocusStack stack(kWidth, kHeight, PixelFormat::kMono8, settings, pool);
  std::vector<std::byte> pixels(static_cast<std::size_t>(kWidth) * kHeight);
  sim::ExposureRequest request;
  request.width = kWidth;
  request.height = kHeight;
  for (int k = 0; k < kSlices; ++k) {
    const double z_um = kStep_um * (k - kSlices / 2) + 2.0;
    request.exposure_index = static_cast<std::uint64_t>(k);
    renderer.render(z_um, request, pixels);
    stack.push({PixelFormat::kMono8, kWidth, kHeight, kWidth, pixels.data()}, z_um);
  }
  HeightMap map = stack.finish(PeakMethod::kFiveSample);
  if (smooth_px) {
    map.height_m = smooth_heights(map.height_m, map.sigma_m, {*smooth_px, window_area_px2(settings)}, pool).height_m;
  }
  // Least squares of a constant, a sine and a cosine over whole periods are sums.
  const int columns = static_cast<int>(std::floor((kWidth - 2 * kMargin_px) / period_px) * period_px);
  double sine = 0.0;
  double count = 0.0;
  for (int y = kMargin_px; y < kHeight - kMargin_px; ++y) {
    for (int x = kMargin_px; x < kMargin_px + columns; ++x) {
      const float height_m = map.height_m.at(x, y);
      if (!std::isfinite(height_m)) continue;
      sine += 1e6 * static_cast<double>(height_m) * std::sin(phase(x));
      count += 1.0;
    }
  }
  return 2.0 * sine / count / kAmplitude_um;
}

double measured_lateral_period_px(const FocusSettings& settings, std::optional<double> smooth_px, WorkerPool& pool) {
  double low = 4.0;
  double high = 100.0;
  for (int i = 0; i < 9; ++i) {
    const double middle = std::sqrt(low * high);
    (sine_transfer(settings, smooth_px, middle, pool) > 0.5 ? high : low) = middle;
  }
  return std::sqrt(low * high);
}

}  // namespace fvd::bench
