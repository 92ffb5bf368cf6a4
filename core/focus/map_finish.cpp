#include "core/focus/map_finish.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "core/focus/peak_tiles.hpp"
#include "core/focus/sharpness_rows.hpp"

namespace fvd {

namespace {

/// The texture of a window has its weight not quite in the middle; on a slope that is an error of height: so many
/// windows beside the middle, standard deviation. Measured on the chapter's ramp.
constexpr float kWeightOffset = 0.038F;

/// Every so many rows and columns a curve's width is looked at.
constexpr int kWidthEvery = 4;

/// The share of the full window that is left about a pixel near the border: its sums are smaller by as much, their noise
/// by its root.
double window_share(int centre, int window, int size) {
  const WindowReach reach(centre, window / 2, size);
  return static_cast<double>(reach.last - reach.first + 1) / window;
}

/// Adapts what was computed for full windows to those of row y.
void shrink_windows(int y, int width, int height, int window, float* noise, float* least_amplitude) {
  const double rows = window_share(y, window, height);
  const int inner = rows < 1.0 ? width : std::min(window / 2, width);  // all columns, or those at the ends
  const auto shrink = [&](int x) {
    const double share = rows * window_share(x, window, width);
    noise[x] *= static_cast<float>(std::sqrt(share));
    least_amplitude[x] *= static_cast<float>(share);
  };
  for (int x = 0; x < inner; ++x) shrink(x);
  for (int x = std::max(inner, width - window / 2); x < width; ++x) shrink(x);
}

void add_slope_errors(const FocusSettings& settings, WorkerPool& pool, HeightMap& map) {
  const int reach = settings.window_px / 2;
  const int width = map.height_m.width();
  const int height = map.height_m.height();
  if (reach == 0) return;
  const float factor = kWeightOffset * static_cast<float>(settings.window_px);
  const int bands = pool.threads();
  pool.run(bands, [&](int band) {
    for (int y = height * band / bands; y < height * (band + 1) / bands; ++y) {
      if (y < reach || y >= height - reach) continue;
      focus_kernels().add_slope_error(map.height_m.row(y), map.height_m.row(y - reach), map.height_m.row(y + reach),
                                      reach, factor, width, map.sigma_m.row(y));
    }
  });
}

double median(std::vector<float>& values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return static_cast<double>(*middle);
}

}  // namespace

void finish_map(const CurveSource& curves, const RowFit& fit, const FocusSettings& settings, const NoiseProbe& noise,
                WorkerPool& pool, HeightMap& map) {
  const int width = map.height_m.width();
  const int height = map.height_m.height();
  const int bands = pool.threads();
  PeakTiles tiles(width, height, settings.window_px + settings.distance_px,
                  sharpness_code(settings, map.texture_format).root);
  pool.run(bands, [&](int band) {
    for (int row = tiles.rows() * band / bands; row < tiles.rows() * (band + 1) / bands; ++row) {
      for (int y = tiles.first(row); y < tiles.end(row); ++y) tiles.add_row(y, curves(band, y, nullptr));
    }
  });
  std::vector<std::vector<float>> widths(static_cast<std::size_t>(bands));
  pool.run(bands, [&](int band) {
    std::vector<float> noise_row(static_cast<std::size_t>(width));
    std::vector<float> least(static_cast<std::size_t>(width));
    for (int y = height * band / bands; y < height * (band + 1) / bands; ++y) {
      const CurveRow row = curves(band, y, map.texture.row(y));
      noise.noise_row(y, noise_row.data());
      tiles.least_amplitude(y, least.data());
      shrink_windows(y, width, height, settings.window_px, noise_row.data(), least.data());
      fit.fit(row, noise_row.data(), least.data(), width,
              {map.height_m.row(y), map.sigma_m.row(y), map.prominence.row(y), map.mask.row(y)});
      if (y % kWidthEvery != 0) continue;
      for (int x = 0; x < width; x += kWidthEvery) {
        if (map.mask.at(x, y) != 0) continue;
        const auto curve_width = fit.curve_width_um(row, x);
        if (curve_width) widths[static_cast<std::size_t>(band)].push_back(static_cast<float>(*curve_width));
      }
    }
  });
  add_slope_errors(settings, pool, map);
  map.noise_grey = noise.median();
  for (std::size_t band = 1; band < widths.size(); ++band) {
    widths[0].insert(widths[0].end(), widths[band].begin(), widths[band].end());
  }
  map.curve_width_um = median(widths[0]);
}

}  // namespace fvd
