#include "core/focus/simple_focus_stack.hpp"

#include <algorithm>
#include <cassert>

#include "core/error.hpp"
#include "core/focus/focus_point.hpp"
#include "core/focus/sharpness_rows.hpp"

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
  for (int v = std::max(y - radius, 0); v <= std::min(y + radius, pixels.height() - 1); ++v) {
    for (int u = std::max(x - radius, 0); u <= std::min(x + radius, pixels.width() - 1); ++u) {
      if (pixels.at(u, v) >= level) return true;
    }
  }
  return false;
}

}  // namespace

SimpleFocusStack::SimpleFocusStack(const FocusSettings& settings) : settings_(settings) {
  check_focus_settings(settings);
}

void SimpleFocusStack::push(const ImageView& slice, double z_um) {
  assert(pixels_.empty() || (pixels_[0].width() == slice.width && pixels_[0].height() == slice.height));
  format_ = slice.format;
  sharpness_.push_back(sharpness_reference(slice, settings_.window_px, settings_.distance_px));
  pixels_.push_back(widened(slice));
  z_um_.push_back(z_um);
}

HeightMap SimpleFocusStack::finish(PeakMethod method) const {
  if (sharpness_.empty()) throw Error(ErrorCode::kBadSlice, "a height map needs slices; there are none");
  const int width = pixels_[0].width();
  const int height = pixels_[0].height();
  HeightMap map{Plane<float>(width, height), Plane<std::uint8_t>(width, height), Plane<float>(width, height), format_,
                Plane<std::uint16_t>(width, height)};
  std::vector<std::uint32_t> curve(sharpness_.size());
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (std::size_t k = 0; k < curve.size(); ++k) curve[k] = sharpness_[k].at(x, y);
      const auto peak = std::max_element(curve.begin(), curve.end());
      const auto index = static_cast<std::size_t>(peak - curve.begin());
      FocusCurve condensed;
      condensed.peak = *peak;
      condensed.left = index > 0 ? curve[index - 1] : 0;
      condensed.right = index + 1 < curve.size() ? curve[index + 1] : 0;
      condensed.minimum = *std::min_element(curve.begin(), curve.end());
      condensed.peak_index = static_cast<int>(index);
      condensed.saturated = window_saturated(pixels_[index], x, y, settings_.window_px / 2, max_grey_level(format_));
      const FocusPoint point = resolve_point(condensed, z_um_, method, settings_.min_prominence);
      map.height_m.at(x, y) = point.height_m;
      map.mask.at(x, y) = point.mask;
      map.prominence.at(x, y) = point.prominence;
      map.texture.at(x, y) = pixels_[index].at(x, y);
    }
  }
  return map;
}

}  // namespace fvd
