#include "core/focus/simple_focus_stack.hpp"

#include <algorithm>
#include <array>
#include <cassert>

#include "core/error.hpp"
#include "core/focus/noise_probe.hpp"
#include "core/focus/peak_accumulator.hpp"
#include "core/focus/row_fit.hpp"
#include "core/focus/sharpness_rows.hpp"
#include "core/pipeline/worker_pool.hpp"

namespace fvd {

namespace {

Plane<std::uint16_t> widened(const ImageView& slice) {
  Plane<std::uint16_t> pixels(slice.width, slice.height);
  for (int y = 0; y < slice.height; ++y) {
    if (slice.format == PixelFormat::kMono8) {
      std::copy_n(slice.as<std::uint8_t>().row(y), slice.width, pixels.row(y));
    } else {
      std::copy_n(slice.as<std::uint16_t>().row(y), slice.width, pixels.row(y));
    }
  }
  return pixels;
}

bool window_saturated(const Plane<std::uint16_t>& pixels, int x, int y, int radius, int level) {
  const int columns = std::min({radius, x, pixels.width() - 1 - x});
  const int rows = std::min({radius, y, pixels.height() - 1 - y});
  for (int v = y - rows; v <= y + rows; ++v) {
    for (int u = x - columns; u <= x + columns; ++u) {
      if (pixels.at(u, v) >= level) return true;
    }
  }
  return false;
}

/// The codes of each bin's slices, shifted to fit and summed; an incomplete last bin raised to a full one.
std::vector<std::uint16_t> binned(const std::vector<std::uint16_t>& codes, std::size_t bin) {
  if (bin == 1) return codes;
  const int shift = bin_shift(static_cast<int>(bin));
  std::vector<std::uint16_t> samples;
  for (std::size_t first = 0; first < codes.size(); first += bin) {
    const std::size_t end = std::min(first + bin, codes.size());
    unsigned sum = 0;
    for (std::size_t k = first; k < end; ++k) sum += (codes[k] + (1U << (shift - 1))) >> shift;
    if (end - first < bin) sum = static_cast<unsigned>(sum * bin / (end - first));
    samples.push_back(static_cast<std::uint16_t>(std::min(sum, 65535U)));
  }
  return samples;
}

/// A curve's condensed form in the columns that a fit reads, one pixel wide.
struct OneCurve {
  OneCurve(const std::vector<std::uint16_t>& samples, std::size_t peak_at, bool window_saturated)
      : saturated(window_saturated ? 1 : 0) {
    const auto at = [&](std::ptrdiff_t offset) -> std::uint16_t {
      const auto i = static_cast<std::ptrdiff_t>(peak_at) + offset;
      return i < 0 || i >= static_cast<std::ptrdiff_t>(samples.size()) ? std::uint16_t{0}
                                                                       : samples[static_cast<std::size_t>(i)];
    };
    values = {0,
              0,
              at(0),
              at(-1),
              at(-2),
              at(1),
              at(2),
              *std::min_element(samples.begin(), samples.end()),
              static_cast<std::uint16_t>(peak_at)};
  }
  [[nodiscard]] CurveRow row() {
    return {&values[0], &values[1], &values[2], &values[3], &values[4],
            &values[5], &values[6], &values[7], &values[8], &saturated};
  }
  std::array<std::uint16_t, 9> values{};
  std::uint8_t saturated;
};

}  // namespace

SimpleFocusStack::SimpleFocusStack(const FocusSettings& settings) : settings_(settings) {
  check_focus_settings(settings);
}

void SimpleFocusStack::push(const ImageView& slice, double z_um) {
  assert(pixels_.empty() || (pixels_[0].width() == slice.width && pixels_[0].height() == slice.height));
  format_ = slice.format;
  sharpness_.push_back(sharpness_reference(slice, settings_));
  pixels_.push_back(widened(slice));
  z_um_.push_back(z_um);
}

HeightMap SimpleFocusStack::finish(PeakMethod method) const {
  if (sharpness_.empty()) throw Error(ErrorCode::kBadSlice, "a height map needs slices; there are none");
  const int width = pixels_[0].width();
  const int height = pixels_[0].height();
  const auto bin = static_cast<std::size_t>(settings_.bin_slices);
  HeightMap map = empty_map(width, height, format_);
  SampleHeights heights(settings_.bin_slices, static_cast<int>(z_um_.size()));
  for (const double z : z_um_) heights.push(z);
  const RowFit fit(heights.means_um(), settings_, format_, method);
  WorkerPool pool(1);
  NoiseProbe noise(width, height);
  for (const auto& slice : pixels_) noise.add(image_view(slice.view(), PixelFormat::kMono16), pool);
  std::vector<float> noise_row(static_cast<std::size_t>(width));
  std::vector<std::uint16_t> curve(sharpness_.size());
  for (int y = 0; y < height; ++y) {
    noise.noise_row(y, noise_row.data());
    for (int x = 0; x < width; ++x) {
      for (std::size_t k = 0; k < curve.size(); ++k) curve[k] = sharpness_[k].at(x, y);
      const std::vector<std::uint16_t> samples = binned(curve, bin);
      const auto peak = static_cast<std::size_t>(std::max_element(samples.begin(), samples.end()) - samples.begin());
      const std::size_t first = peak * bin;
      const std::size_t end = std::min(first + bin, curve.size());
      bool saturated = false;
      for (std::size_t k = first; k < end; ++k) {
        saturated = saturated || window_saturated(pixels_[k], x, y, settings_.window_px / 2, max_grey_level(format_));
      }
      OneCurve one(samples, peak, saturated);
      fit.fit(one.row(), &noise_row[static_cast<std::size_t>(x)], 1,
              {&map.height_m.at(x, y), &map.sigma_m.at(x, y), &map.prominence.at(x, y), &map.mask.at(x, y)});
      // The middle slice of the bin, or the first where the bin ends before its middle.
      const std::size_t middle = first + (bin - 1) / 2;
      map.texture.at(x, y) = pixels_[middle < end ? middle : first].at(x, y);
    }
  }
  map.noise_grey = noise.median();
  return map;
}

}  // namespace fvd
