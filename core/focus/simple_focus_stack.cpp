#include "core/focus/simple_focus_stack.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <optional>

#include "core/base/error.hpp"
#include "core/focus/fit/map_finish.hpp"
#include "core/focus/measure/noise_probe.hpp"
#include "core/focus/measure/peak_accumulator.hpp"
#include "core/focus/measure/sharpness_rows.hpp"
#include "core/runtime/worker_pool.hpp"

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

std::uint8_t clipped_level(const Plane<std::uint16_t>& pixels, int x, int y, const FocusSettings& settings, int full) {
  const ClippedLevels levels(settings);
  if (!levels.looked_for()) return 0;
  const WindowReach columns(x, settings.window_px / 2, pixels.width());
  const WindowReach rows(y, settings.window_px / 2, pixels.height());
  int count = 0;
  for (int v = rows.first; v <= rows.last; ++v) {
    for (int u = columns.first; u <= columns.last; ++u) count += pixels.at(u, v) >= full ? 1 : 0;
  }
  return levels.of(count);
}

/// What the levels of the peak's sample and of those on both sides say of it; a side that is not there is nullopt.
std::uint8_t clipped_peak(std::optional<int> before, int at, std::optional<int> after) {
  const int left = before.value_or(at) - at;
  const int right = after.value_or(at) - at;
  if (at == clipping::kTooMuch || left > clipping::kMostGrowth || right > clipping::kMostGrowth || left * right < 0)
    return clipping::kNoPeak;
  if (at >= clipping::kManyLevel) return clipping::kMany;
  return at > 0 ? clipping::kSome : std::uint8_t{0};
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

/// The highest sample far from the peak and beyond a valley, see second_peak; 0 = none.
std::uint16_t second_peak_of(const std::vector<std::uint16_t>& samples, std::uint16_t valley_share) {
  // Whether a valley and enough samples lie from one sample to a later one.
  const auto parted = [&](std::size_t from, std::size_t to) {
    const auto at = [&](std::size_t i) { return samples.begin() + static_cast<std::ptrdiff_t>(i); };
    return to - from >= second_peak::kDistance &&
           *std::min_element(at(from), at(to + 1)) < second_peak::valley(samples[from], valley_share);
  };
  std::uint16_t highest = 0;
  std::size_t peak = 0;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    if (samples[i] <= samples[peak]) continue;
    if (parted(peak, i)) highest = samples[peak];  // of those overtaken the later is the higher
    peak = i;
  }
  for (std::size_t i = peak + 1; i < samples.size(); ++i) {
    if (parted(peak, i)) highest = std::max(highest, samples[i]);
  }
  return highest;
}

/// A row's curves in their condensed form.
struct CondensedRow {
  CondensedRow(int width, std::uint16_t share) : clipped(static_cast<std::size_t>(width)), valley_share(share) {
    for (auto& column : columns) column.resize(static_cast<std::size_t>(width));
  }
  void set(int x, const std::vector<std::uint16_t>& samples, std::size_t peak_at, std::uint8_t clipped_there) {
    const auto at = [&](std::ptrdiff_t offset) -> std::uint16_t {
      const auto i = static_cast<std::ptrdiff_t>(peak_at) + offset;
      return i < 0 || i >= static_cast<std::ptrdiff_t>(samples.size()) ? std::uint16_t{0}
                                                                       : samples[static_cast<std::size_t>(i)];
    };
    const std::array<std::uint16_t, 10> values{
        0,
        0,
        at(0),
        at(-1),
        at(-2),
        at(1),
        at(2),
        *std::min_element(samples.begin(), samples.end()),
        static_cast<std::uint16_t>(peak_at),
        valley_share > 0 ? second_peak_of(samples, valley_share) : std::uint16_t{0}};
    for (std::size_t i = 0; i < values.size(); ++i) columns[i][static_cast<std::size_t>(x)] = values[i];
    clipped[static_cast<std::size_t>(x)] = clipped_there;
  }
  [[nodiscard]] CurveRow row() {
    return {columns[0].data(),
            columns[1].data(),
            columns[2].data(),
            columns[3].data(),
            columns[4].data(),
            columns[5].data(),
            columns[6].data(),
            columns[7].data(),
            columns[8].data(),
            clipped.data(),
            0,
            valley_share > 0 ? columns[9].data() : nullptr,
            valley_share};
  }
  std::array<std::vector<std::uint16_t>, 10> columns;
  std::vector<std::uint8_t> clipped;
  std::uint16_t valley_share;
};

}  // namespace

SimpleFocusStack::SimpleFocusStack(const FocusSettings& settings) : settings_(settings) {
  check_focus_settings(settings);
}

void SimpleFocusStack::push(const ImageView& slice, double z_um, double gain) {
  assert(pixels_.empty() || (pixels_[0].width() == slice.width && pixels_[0].height() == slice.height));
  format_ = slice.format;
  sharpness_.push_back(sharpness_reference(slice, settings_, gain));
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
  WorkerPool pool(1);
  NoiseProbe noise(width, height);
  for (const auto& slice : pixels_) noise.add(image_view(slice.view(), PixelFormat::kMono16), pool);
  CondensedRow condensed(width, state_parts(settings_, format_).valley_share);
  std::vector<std::uint16_t> curve(sharpness_.size());
  const auto curves = [&](int /*thread*/, int y, std::uint16_t* texture) {
    for (int x = 0; x < width; ++x) {
      for (std::size_t k = 0; k < curve.size(); ++k) curve[k] = sharpness_[k].at(x, y);
      const std::vector<std::uint16_t> samples = binned(curve, bin);
      const auto peak = static_cast<std::size_t>(std::max_element(samples.begin(), samples.end()) - samples.begin());
      const std::size_t first = peak * bin;
      const std::size_t end = std::min(first + bin, curve.size());
      const auto level = [&](std::size_t sample) -> std::optional<int> {  // the highest of its slices
        if (sample >= samples.size()) return std::nullopt;
        int highest = 0;
        for (std::size_t k = sample * bin; k < std::min((sample + 1) * bin, curve.size()); ++k) {
          highest = std::max<int>(highest, clipped_level(pixels_[k], x, y, settings_, max_grey_level(format_)));
        }
        return highest;
      };
      condensed.set(x, samples, peak, clipped_peak(level(peak - 1), level(peak).value(), level(peak + 1)));
      // The middle slice of the bin, or the first where the bin ends before its middle.
      const std::size_t middle = first + (bin - 1) / 2;
      if (texture != nullptr) texture[x] = pixels_[middle < end ? middle : first].at(x, y);
    }
    return condensed.row();
  };
  finish_map(curves, heights.means_um(), settings_, method, noise, pool, map);
  return map;
}

}  // namespace fvd
