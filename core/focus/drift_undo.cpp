#include "core/focus/drift_undo.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace fvd {

namespace {

/// The index of the element that stands at `at` of so many, mirrored at both ends. |shift| < count keeps it in range.
int mirrored(int at, int count) noexcept {
  if (at < 0) return -at - 1;
  return at < count ? at : 2 * count - at - 1;
}

/// out(x, y) = in(x + dx, y + dy). |dx| < width, |dy| < height.
void copy_shifted(const std::byte* in, std::ptrdiff_t row_stride, int width, int height, std::size_t pixel_bytes,
                  int dx, int dy, std::byte* out) {
  const int first = std::max(0, -dx);
  const int end = std::min(width, width - dx);
  const auto bytes = [pixel_bytes](int pixels) { return static_cast<std::size_t>(pixels) * pixel_bytes; };
  for (int y = 0; y < height; ++y) {
    const std::byte* const row = in + mirrored(y + dy, height) * row_stride;
    std::byte* const to = out + static_cast<std::size_t>(y) * bytes(width);
    std::memcpy(to + bytes(first), row + bytes(first + dx), bytes(end - first));
    const auto copy = [&](int x) { std::memcpy(to + bytes(x), row + bytes(mirrored(x + dx, width)), pixel_bytes); };
    for (int x = 0; x < first; ++x) copy(x);
    for (int x = end; x < width; ++x) copy(x);
  }
}

int whole(double shift_px, int side) {
  return static_cast<int>(std::lround(std::clamp(shift_px, 1.0 - side, side - 1.0)));
}

}  // namespace

void DriftUndo::apply(std::vector<ZSlice>& batch) {
  if (path_.empty()) return;
  if (pixels_.size() < batch.size()) pixels_.resize(batch.size());
  if (colours_.size() < batch.size()) colours_.resize(batch.size());
  for (std::size_t i = 0; i < batch.size(); ++i) {
    ZSlice& slice = batch[i];
    ImageView& image = slice.image;
    const DriftPath::Place place = path_.at(slice.z_um);
    const int dx = whole(place.x_px, image.width);
    const int dy = whole(place.y_px, image.height);
    if (dx == 0 && dy == 0) continue;
    border_.left = std::max(border_.left, -dx);
    border_.right = std::max(border_.right, dx);
    border_.top = std::max(border_.top, -dy);
    border_.bottom = std::max(border_.bottom, dy);
    const auto pixel_bytes = static_cast<std::size_t>(bytes_per_pixel(image.format));
    const std::size_t points = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
    pixels_[i].resize(points * pixel_bytes);
    copy_shifted(image.data, image.row_stride_bytes, image.width, image.height, pixel_bytes, dx, dy, pixels_[i].data());
    image.data = pixels_[i].data();
    image.row_stride_bytes = image.width * static_cast<std::ptrdiff_t>(pixel_bytes);
    if (slice.colour == nullptr) continue;
    colours_[i].resize(3 * points);
    copy_shifted(reinterpret_cast<const std::byte*>(slice.colour), 3 * static_cast<std::ptrdiff_t>(image.width),
                 image.width, image.height, 3, dx, dy, reinterpret_cast<std::byte*>(colours_[i].data()));
    slice.colour = colours_[i].data();
  }
}

void hide_border(HeightMap& map, const HiddenBorder& border, int reach_px) {
  if (border == HiddenBorder{}) return;
  const int width = map.mask.width();
  const int height = map.mask.height();
  // A side on which nothing is hidden keeps its points.
  const auto depth = [reach_px](int hidden) { return hidden > 0 ? hidden + reach_px : 0; };
  const int left = std::min(width, depth(border.left));
  const int right = std::max(left, width - depth(border.right));
  for (int y = 0; y < height; ++y) {
    const bool whole_row = y < depth(border.top) || y >= height - depth(border.bottom);
    const auto hide = [&](int first, int end) {
      for (int x = first; x < end; ++x) {
        map.mask.at(x, y) |= mask_reason::kOutOfView;
        map.height_m.at(x, y) = std::numeric_limits<float>::quiet_NaN();
        map.sigma_m.at(x, y) = std::numeric_limits<float>::quiet_NaN();
      }
    };
    hide(0, whole_row ? width : left);
    if (!whole_row) hide(right, width);
  }
}

}  // namespace fvd
