#include "core/focus/sharpness_rows.hpp"

#include <algorithm>

#include "core/focus/vector_clones.hpp"

namespace fvd {

namespace {

FVD_VECTOR_CLONES void add_row(std::uint32_t* __restrict columns, const std::uint16_t* __restrict row, int width) {
  for (int x = 0; x < width; ++x) columns[x] += row[x];
}
FVD_VECTOR_CLONES void add_row(std::uint32_t* __restrict columns, const std::uint32_t* __restrict row, int width) {
  for (int x = 0; x < width; ++x) columns[x] += row[x];
}
FVD_VECTOR_CLONES void subtract_row(std::uint32_t* __restrict columns, const std::uint16_t* __restrict row, int width) {
  for (int x = 0; x < width; ++x) columns[x] -= row[x];
}
FVD_VECTOR_CLONES void subtract_row(std::uint32_t* __restrict columns, const std::uint32_t* __restrict row, int width) {
  for (int x = 0; x < width; ++x) columns[x] -= row[x];
}

/// out[x] = sum of columns[x - radius .. x + radius], clipped to 0..width-1.
template <typename Value, typename Emit>
void slide(const Value* columns, int width, int radius, Emit emit) {
  std::uint32_t sum = 0;
  for (int x = 0; x < std::min(radius, width); ++x) sum += columns[x];
  const int entering_end = std::max(0, width - radius);
  const int leaving_begin = std::min(width, radius + 1);
  int x = 0;
  for (; x < std::min(leaving_begin, entering_end); ++x) emit(x, sum += columns[x + radius]);
  for (; x < entering_end; ++x) emit(x, sum += columns[x + radius] - columns[x - radius - 1]);
  for (; x < leaving_begin; ++x) emit(x, sum);
  for (; x < width; ++x) emit(x, sum -= columns[x - radius - 1]);
}

FVD_VECTOR_CLONES int row_maximum(const std::uint8_t* row, int width) {
  std::uint8_t largest = 0;
  for (int x = 0; x < width; ++x) largest = row[x] > largest ? row[x] : largest;
  return largest;
}
FVD_VECTOR_CLONES int row_maximum(const std::uint16_t* row, int width) {
  std::uint16_t largest = 0;
  for (int x = 0; x < width; ++x) largest = row[x] > largest ? row[x] : largest;
  return largest;
}

template <typename Pixel>
Plane<std::uint32_t> reference(PlaneView<const Pixel> image, int window, int distance) {
  const int width = image.width;
  const int height = image.height;
  Plane<LaplacianOf<Pixel>> laplacian(width, height);
  for (int y = 0; y < height; ++y) {
    modified_laplacian_row_scalar(image.row(std::max(y - distance, 0)), image.row(y),
                                  image.row(std::min(y + distance, height - 1)), width, distance, laplacian.row(y));
  }
  Plane<std::uint32_t> sums(width, height);
  const int radius = window / 2;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (int v = std::max(y - radius, 0); v <= std::min(y + radius, height - 1); ++v) {
        for (int u = std::max(x - radius, 0); u <= std::min(x + radius, width - 1); ++u) {
          sums.at(x, y) += laplacian.at(u, v);
        }
      }
    }
  }
  return sums;
}

}  // namespace

template <typename Pixel>
SharpnessRows<Pixel>::SharpnessRows(int width, int window, int distance)
    : width_(width),
      window_(window),
      radius_(window / 2),
      distance_(distance),
      ring_(static_cast<std::size_t>(width) * static_cast<std::size_t>(window)),
      columns_(static_cast<std::size_t>(width)),
      sums_(static_cast<std::size_t>(width)),
      saturated_columns_(static_cast<std::size_t>(width)),
      saturated_(static_cast<std::size_t>(width)) {}

template <typename Pixel>
std::size_t SharpnessRows<Pixel>::memory_bytes(int width, int window) {
  return static_cast<std::size_t>(width) *
         (static_cast<std::size_t>(window) * sizeof(Laplacian) + 2 * sizeof(std::uint32_t) + 2);
}

template <typename Pixel>
auto SharpnessRows<Pixel>::ring_row(int y) noexcept -> Laplacian* {
  return ring_.data() + static_cast<std::ptrdiff_t>(y % window_) * width_;
}

template <typename Pixel>
bool SharpnessRows<Pixel>::row_saturated(int y) const noexcept {
  return row_maximum(image_.row(y), width_) >= saturation_;
}

template <typename Pixel>
void SharpnessRows<Pixel>::begin(PlaneView<const Pixel> image, int first, int saturation) noexcept {
  image_ = image;
  saturation_ = saturation;
  y_ = first;
  saturated_rows_ = 0;
  std::fill(columns_.begin(), columns_.end(), 0U);
  std::fill(saturated_columns_.begin(), saturated_columns_.end(), std::uint8_t{0});
  // All rows of the first window but its last, which next() adds.
  for (int y = std::max(first - radius_, 0); y < std::min(first + radius_, image.height); ++y) enter(y);
}

template <typename Pixel>
void SharpnessRows<Pixel>::enter(int y) noexcept {
  Laplacian* row = ring_row(y);
  modified_laplacian_row(image_.row(std::max(y - distance_, 0)), image_.row(y),
                         image_.row(std::min(y + distance_, image_.height - 1)), width_, distance_, row);
  add_row(columns_.data(), row, width_);
  if (!row_saturated(y)) return;
  ++saturated_rows_;
  const Pixel* pixels = image_.row(y);
  for (int x = 0; x < width_; ++x) {
    const auto column = static_cast<std::size_t>(x);
    saturated_columns_[column] =
        static_cast<std::uint8_t>(saturated_columns_[column] + (pixels[x] >= saturation_ ? 1 : 0));
  }
}

template <typename Pixel>
void SharpnessRows<Pixel>::leave(int y) noexcept {
  subtract_row(columns_.data(), ring_row(y), width_);
  if (saturated_rows_ == 0 || !row_saturated(y)) return;
  --saturated_rows_;
  const Pixel* pixels = image_.row(y);
  for (int x = 0; x < width_; ++x) {
    const auto column = static_cast<std::size_t>(x);
    saturated_columns_[column] =
        static_cast<std::uint8_t>(saturated_columns_[column] - (pixels[x] >= saturation_ ? 1 : 0));
  }
}

template <typename Pixel>
void SharpnessRows<Pixel>::next() noexcept {
  if (y_ + radius_ < image_.height) enter(y_ + radius_);
  sum_columns();
  find_saturated();
  if (y_ - radius_ >= 0) leave(y_ - radius_);
  ++y_;
}

template <typename Pixel>
void SharpnessRows<Pixel>::sum_columns() noexcept {
  slide(columns_.data(), width_, radius_,
        [this](int x, std::uint32_t sum) { sums_[static_cast<std::size_t>(x)] = sum; });
}

template <typename Pixel>
void SharpnessRows<Pixel>::find_saturated() noexcept {
  if (saturated_rows_ == 0) {
    std::fill(saturated_.begin(), saturated_.end(), std::uint8_t{0});
    return;
  }
  slide(saturated_columns_.data(), width_, radius_,
        [this](int x, std::uint32_t count) { saturated_[static_cast<std::size_t>(x)] = count > 0 ? 1 : 0; });
}

Plane<std::uint32_t> sharpness_reference(const ImageView& image, int window, int distance) {
  return image.format == PixelFormat::kMono8 ? reference(image.as<std::uint8_t>(), window, distance)
                                             : reference(image.as<std::uint16_t>(), window, distance);
}

template class SharpnessRows<std::uint8_t>;
template class SharpnessRows<std::uint16_t>;

}  // namespace fvd
