#pragma once

/// Two-dimensional data: row 0 on top, x right, y down; strides in elements so that rows may be padded.

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include "core/base/large_array.hpp"

namespace fvd {

/// A view of a plane of shape [height][width]. Does not own the elements; their owner outlives it.
template <typename T>
struct PlaneView {
  T* data = nullptr;
  int width = 0;
  int height = 0;
  std::ptrdiff_t row_stride = 0;  ///< elements from one row to the next, >= width

  [[nodiscard]] T* row(int y) const {
    assert(y >= 0 && y < height);
    return data + y * row_stride;
  }
  [[nodiscard]] T& at(int x, int y) const { return row(y)[x]; }
  operator PlaneView<const T>() const { return {data, width, height, row_stride}; }
};

/// An owned plane of shape [height][width], rows contiguous. Moves are cheap; copies are explicit through clone().
template <typename T>
class Plane {
 public:
  Plane() = default;
  Plane(int width, int height, T fill = T{}) : Plane(unset(width, height)) { std::fill_n(data_.data(), size(), fill); }
  /// Uninitialised; the caller must write every element, e.g. from several threads. pages: where the memory comes from
  /// and goes to, if given.
  [[nodiscard]] static Plane unset(int width, int height, KeptPagesPtr pages = nullptr) {
    Plane plane;
    plane.width_ = width;
    plane.height_ = height;
    plane.data_ = LargeArray<T>(plane.size(), std::move(pages));
    return plane;
  }
  Plane(Plane&& other) noexcept
      : width_(std::exchange(other.width_, 0)),
        height_(std::exchange(other.height_, 0)),
        data_(std::move(other.data_)) {}
  Plane& operator=(Plane&& other) noexcept {
    width_ = std::exchange(other.width_, 0);
    height_ = std::exchange(other.height_, 0);
    data_ = std::move(other.data_);
    return *this;
  }
  Plane(const Plane&) = delete;
  Plane& operator=(const Plane&) = delete;
  ~Plane() = default;

  [[nodiscard]] Plane clone() const {
    Plane copy = unset(width_, height_);
    std::copy_n(data_.data(), size(), copy.data_.data());
    return copy;
  }

  [[nodiscard]] int width() const noexcept { return width_; }
  [[nodiscard]] int height() const noexcept { return height_; }
  [[nodiscard]] bool empty() const noexcept { return size() == 0; }
  [[nodiscard]] T* row(int y) { return data_.data() + static_cast<std::ptrdiff_t>(y) * width_; }
  [[nodiscard]] const T* row(int y) const { return data_.data() + static_cast<std::ptrdiff_t>(y) * width_; }
  [[nodiscard]] T& at(int x, int y) { return row(y)[x]; }
  [[nodiscard]] const T& at(int x, int y) const { return row(y)[x]; }
  [[nodiscard]] std::span<T> pixels() { return {data_.data(), size()}; }
  [[nodiscard]] std::span<const T> pixels() const { return {data_.data(), size()}; }
  [[nodiscard]] PlaneView<T> view() { return {data_.data(), width_, height_, width_}; }
  [[nodiscard]] PlaneView<const T> view() const { return {data_.data(), width_, height_, width_}; }

 private:
  [[nodiscard]] std::size_t size() const noexcept {
    return static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
  }

  int width_ = 0;
  int height_ = 0;
  LargeArray<T> data_;
};

/// Formats that fvd measures with, by their GenICam PFNC names. Formats of more than 8 bits take 16 bits per pixel,
/// little-endian, the value in the lower bits.
enum class PixelFormat { kMono8, kMono10, kMono12, kMono16 };

[[nodiscard]] constexpr int significant_bits(PixelFormat format) {
  switch (format) {
    case PixelFormat::kMono8:
      return 8;
    case PixelFormat::kMono10:
      return 10;
    case PixelFormat::kMono12:
      return 12;
    case PixelFormat::kMono16:
      return 16;
  }
  return 8;
}
[[nodiscard]] constexpr int bytes_per_pixel(PixelFormat format) { return format == PixelFormat::kMono8 ? 1 : 2; }
[[nodiscard]] constexpr int max_grey_level(PixelFormat format) { return (1 << significant_bits(format)) - 1; }

/// A view of a grey image of 8 or 16 bits per pixel; the form in which slices are passed. Does not own the pixels.
struct ImageView {
  PixelFormat format = PixelFormat::kMono8;
  int width = 0;
  int height = 0;
  std::ptrdiff_t row_stride_bytes = 0;  ///< a multiple of the pixel's size
  const std::byte* data = nullptr;      ///< aligned to the pixel's size

  /// The pixels as std::uint8_t (Mono8) or std::uint16_t (all others). The type must match the format.
  template <typename T>
  [[nodiscard]] PlaneView<const T> as() const {
    assert(static_cast<int>(sizeof(T)) == bytes_per_pixel(format));
    return {reinterpret_cast<const T*>(data), width, height, row_stride_bytes / static_cast<std::ptrdiff_t>(sizeof(T))};
  }
};

/// The image view of a plane of 8-bit or 16-bit pixels.
template <typename T>
[[nodiscard]] ImageView image_view(PlaneView<T> plane, PixelFormat format) {
  assert(static_cast<int>(sizeof(T)) == bytes_per_pixel(format));
  return {format, plane.width, plane.height, plane.row_stride * static_cast<std::ptrdiff_t>(sizeof(T)),
          reinterpret_cast<const std::byte*>(plane.data)};
}

}  // namespace fvd
