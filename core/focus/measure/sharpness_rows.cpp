#include "core/focus/measure/sharpness_rows.hpp"

#include <algorithm>

#include "core/focus/measure/operator_value.hpp"

namespace fvd {

namespace {

/// Elements of 16 or 32 bits: whole cache lines, so that a vector of the kernels never lies in two of them.
std::size_t row_pitch(int width) { return (static_cast<std::size_t>(width) + 31) / 32 * 32; }

template <typename T>
void set_zero(LargeArray<T>& values) noexcept {
  std::fill_n(values.data(), values.size(), T{0});
}

std::uint16_t linear_code(std::uint32_t sum, int shift) {
  return static_cast<std::uint16_t>(shift == 0 ? sum : (sum + (1U << (shift - 1))) >> shift);
}

/// Windows about x = first .. end - 1, each from the one before: their ends only move to the right.
template <typename Sum>
void slide_windows(const Sum* values, int width, int radius, int first, int end, Sum* out) {
  int left = WindowReach(first, radius, width).first;
  int right = left;
  Sum sum = 0;  // of [left, right)
  for (int x = first; x < end; ++x) {
    const WindowReach reach(x, radius, width);
    while (right <= reach.last) sum = static_cast<Sum>(sum + values[right++]);
    while (left < reach.first) sum = static_cast<Sum>(sum - values[left++]);
    out[x] = sum;
  }
}

/// The kernel's sums reach from `radius` to width - radius; nearer to the ends the window shrinks.
template <typename Sum>
void sum_ends(const Sum* values, int width, int radius, Sum* out) {
  const int left_end = std::min(radius, width);
  slide_windows(values, width, radius, 0, left_end, out);
  slide_windows(values, width, radius, std::max(left_end, width - radius), width, out);
}

}  // namespace

template <typename Pixel>
SharpnessRows<Pixel>::SharpnessRows(int width, const FocusSettings& settings, PixelFormat format)
    : kernels_(focus_kernels()),
      width_(width),
      pitch_(row_pitch(width)),
      window_(settings.window_px),
      sides_(window_sides(settings)),
      distance_(settings.distance_px),
      operator_(settings.focus_operator),
      code_(sharpness_code(settings, format)),
      saturation_(max_grey_level(format)),
      levels_(settings),
      narrow_(!code_.root),
      codes_(pitch_),
      saturated_columns_(pitch_),
      saturated_counts_(pitch_),
      clipped_(pitch_) {
  if (narrow_) {
    resize(narrow_columns_);
  } else {
    resize(wide_columns_);
  }
}

template <typename Pixel>
template <typename Sum>
void SharpnessRows<Pixel>::resize(Columns<Sum>& columns) {
  columns.ring = LargeArray<Sum>(pitch_ * static_cast<std::size_t>(sides_.first));
  for (auto* row : {&columns.fresh, &columns.sums, &columns.scaled, &columns.windows}) *row = LargeArray<Sum>(pitch_);
  if (sides_.second == 1) return;
  columns.second_ring = LargeArray<Sum>(pitch_ * static_cast<std::size_t>(sides_.second));
  for (auto* row : {&columns.second_sums, &columns.second_scaled}) *row = LargeArray<Sum>(pitch_);
}

template <typename Pixel>
std::size_t SharpnessRows<Pixel>::memory_bytes(int width, const FocusSettings& settings) {
  const WindowSides sides = window_sides(settings);
  const int rows = sides.first + 4 + (sides.second == 1 ? 0 : sides.second + 2);
  return row_pitch(width) * (static_cast<std::size_t>(rows) * sizeof(std::uint32_t) + 3 * sizeof(std::uint16_t) + 1);
}

template <typename Pixel>
bool SharpnessRows<Pixel>::row_saturated(int y) const noexcept {
  if constexpr (sizeof(Pixel) == 1) return kernels_.maximum_u8(image_.row(y), width_) >= saturation_;
  if constexpr (sizeof(Pixel) == 2) return kernels_.maximum_u16(image_.row(y), width_) >= saturation_;
}

template <typename Pixel>
template <typename Sum>
void SharpnessRows<Pixel>::clear(Columns<Sum>& columns) noexcept {
  for (auto* rows : {&columns.ring, &columns.sums, &columns.second_ring, &columns.second_sums}) set_zero(*rows);
}

template <typename Pixel>
void SharpnessRows<Pixel>::begin(PlaneView<const Pixel> image, int first, double gain) noexcept {
  image_ = image;
  scale_ = CodeScale(gain, operator_, code_.root);
  y_ = first;
  saturated_rows_ = 0;
  if (narrow_) {
    clear(narrow_columns_);
  } else {
    clear(wide_columns_);
  }
  set_zero(saturated_columns_);
  counted_.begin(first, window_, image.height);
  second_.begin(first, sides_.second, image.height);
  first_.begin(second_.low, sides_.first, image.height);
}

template <typename Pixel>
void SharpnessRows<Pixel>::compute_row(int y, std::uint32_t* out) noexcept {
  const auto rows = rows_about(image_, y, distance_);
  switch (operator_) {
    case FocusOperator::kIntensity:
      std::transform(rows.row, rows.row + width_, out,
                     [shift = code_.operator_shift](Pixel grey) { return static_cast<std::uint32_t>(grey) >> shift; });
      return;
    case FocusOperator::kTenengrad:
      if constexpr (sizeof(Pixel) == 1) {
        kernels_.tenengrad_u8(rows.above, rows.row, rows.below, width_, distance_, code_.operator_shift, out);
      } else {
        kernels_.tenengrad_u16(rows.above, rows.row, rows.below, width_, distance_, code_.operator_shift, out);
      }
      break;
    case FocusOperator::kDiagonalLaplacian:
      if constexpr (sizeof(Pixel) == 1) {
        kernels_.diagonal_u8(rows, width_, code_.operator_shift, out);
      } else {
        kernels_.diagonal_u16(rows, width_, code_.operator_shift, out);
      }
      break;
    case FocusOperator::kModifiedLaplacian:
      // Of 8 bits it always fits narrow sums.
      if constexpr (sizeof(Pixel) == 2) {
        kernels_.laplacian_u16(rows.above, rows.row, rows.below, width_, distance_, code_.operator_shift, out);
      }
      break;
  }
  for_ends([&](int x) { out[x] = operator_value(operator_, rows, x, width_, code_.operator_shift); });
}

/// Calls at(x) for the columns whose neighbours lie beyond the image.
template <typename Pixel>
template <typename At>
void SharpnessRows<Pixel>::for_ends(At at) noexcept {
  const int left_end = std::min(distance_, width_);
  for (int x = 0; x < left_end; ++x) at(x);
  for (int x = std::max(left_end, width_ - distance_); x < width_; ++x) at(x);
}

/// Several slices are read row by row in turn; the processor's own prefetcher gives each of their rows up at its end.
template <typename Pixel>
void SharpnessRows<Pixel>::prefetch_row(int y) const noexcept {
  if (y >= image_.height) return;
  constexpr std::size_t kCacheLine = 64;
  const auto* bytes = reinterpret_cast<const std::byte*>(image_.row(y));
  const std::size_t size = sizeof(Pixel) * static_cast<std::size_t>(width_);
  for (std::size_t i = 0; i < size; i += kCacheLine) __builtin_prefetch(bytes + i, 0, 2);
}

template <typename Pixel>
void SharpnessRows<Pixel>::enter(Narrow& columns, int y) noexcept {
  if constexpr (sizeof(Pixel) == 1) {
    std::uint16_t* slot = slot_of(columns.ring, y, sides_.first);
    const auto rows = rows_about(image_, y, distance_);
    prefetch_row(y + 1 + distance_);
    if (operator_ == FocusOperator::kDiagonalLaplacian) {
      kernels_.enter_diagonal_u8(rows, width_, code_.shift, columns.sums.data(), slot, columns.scaled.data());
    } else {
      kernels_.enter_laplacian_u8(rows.above, rows.row, rows.below, width_, distance_, code_.shift, columns.sums.data(),
                                  slot, columns.scaled.data());
    }
    for_ends([&](int x) {
      const auto column = static_cast<std::size_t>(x);
      const auto value = static_cast<std::uint16_t>(operator_value(operator_, rows, x, width_, 0));
      columns.sums[column] = static_cast<std::uint16_t>(columns.sums[column] + value - slot[x]);
      slot[x] = value;
      columns.scaled[column] = linear_code(columns.sums[column], code_.shift);
    });
  }
}

template <typename Pixel>
void SharpnessRows<Pixel>::enter(Wide& columns, int y) noexcept {
  compute_row(y, columns.fresh.data());
  kernels_.slide_u32(columns.sums.data(), columns.fresh.data(), slot_of(columns.ring, y, sides_.first), width_);
}

template <typename Pixel>
void SharpnessRows<Pixel>::leave(Narrow& columns, int y) noexcept {
  set_zero(columns.fresh);
  kernels_.slide_u16(columns.sums.data(), columns.fresh.data(), slot_of(columns.ring, y, sides_.first), width_,
                     code_.shift, columns.scaled.data());
}

template <typename Pixel>
void SharpnessRows<Pixel>::leave(Wide& columns, int y) noexcept {
  set_zero(columns.fresh);
  kernels_.slide_u32(columns.sums.data(), columns.fresh.data(), slot_of(columns.ring, y, sides_.first), width_);
}

template <typename Pixel>
void SharpnessRows<Pixel>::enter_second(Narrow& columns, int y) noexcept {
  kernels_.slide_u16(columns.second_sums.data(), columns.scaled.data(), slot_of(columns.second_ring, y, sides_.second),
                     width_, code_.second_shift, columns.second_scaled.data());
}

template <typename Pixel>
void SharpnessRows<Pixel>::enter_second(Wide& columns, int y) noexcept {
  kernels_.slide_u32(columns.second_sums.data(), columns.sums.data(), slot_of(columns.second_ring, y, sides_.second),
                     width_);
}

template <typename Pixel>
void SharpnessRows<Pixel>::leave_second(Narrow& columns, int y) noexcept {
  set_zero(columns.fresh);
  kernels_.slide_u16(columns.second_sums.data(), columns.fresh.data(), slot_of(columns.second_ring, y, sides_.second),
                     width_, code_.second_shift, columns.second_scaled.data());
}

template <typename Pixel>
void SharpnessRows<Pixel>::leave_second(Wide& columns, int y) noexcept {
  set_zero(columns.fresh);
  kernels_.slide_u32(columns.second_sums.data(), columns.fresh.data(), slot_of(columns.second_ring, y, sides_.second),
                     width_);
}

template <typename Pixel>
void SharpnessRows<Pixel>::count_saturated(int y, int change) noexcept {
  if (change < 0 && saturated_rows_ == 0) return;
  if (!levels_.looked_for() || !row_saturated(y)) return;
  saturated_rows_ += change;
  const Pixel* pixels = image_.row(y);
  for (int x = 0; x < width_; ++x) {
    auto& column = saturated_columns_[static_cast<std::size_t>(x)];
    column = static_cast<std::uint16_t>(column + (pixels[x] >= saturation_ ? change : 0));
  }
}

template <typename Pixel>
template <typename Sum>
void SharpnessRows<Pixel>::move_to(Columns<Sum>& columns) noexcept {
  const auto to_row = [&](int y) {
    first_.move_to(
        y, sides_.first, image_.height, [&](int row) { enter(columns, row); }, [&](int row) { leave(columns, row); });
  };
  if (sides_.second == 1) {
    to_row(y_);
    return;
  }
  second_.move_to(
      y_, sides_.second, image_.height,
      [&](int row) {
        to_row(row);
        enter_second(columns, row);
      },
      [&](int row) { leave_second(columns, row); });
}

template <typename Pixel>
void SharpnessRows<Pixel>::next() noexcept {
  if (narrow_) {
    move_to(narrow_columns_);
    emit_narrow();
  } else {
    move_to(wide_columns_);
    emit_wide();
  }
  const WindowReach reach(y_, window_ / 2, image_.height);
  while (counted_.high <= reach.last) count_saturated(counted_.high++, 1);
  while (counted_.low < reach.first) count_saturated(counted_.low++, -1);
  find_clipped();
  if (!scale_.none()) scale_codes();
  ++y_;
}

template <typename Pixel>
void SharpnessRows<Pixel>::scale_codes() noexcept {
  // Blocks of a fixed size: g++ 12 makes vector code of them at -O2 too.
  constexpr int kBlock = 16;
  const CodeScale scale = scale_;
  std::uint16_t* code = codes_.data();
  int left = width_;
  for (; left >= kBlock; left -= kBlock, code += kBlock) {
    for (int i = 0; i < kBlock; ++i) code[i] = scale.apply(code[i]);
  }
  for (int i = 0; i < left; ++i) code[i] = scale.apply(code[i]);
}

template <typename Pixel>
void SharpnessRows<Pixel>::emit_narrow() noexcept {
  Narrow& columns = narrow_columns_;
  if (sides_.second == 1) {
    sum_windows(columns.scaled.data(), sides_.first, codes_.data());
    return;
  }
  sum_windows(columns.second_scaled.data(), sides_.first, columns.windows.data());
  if (code_.third_shift > 0) kernels_.scale_u16(columns.windows.data(), code_.third_shift, width_);
  sum_windows(columns.windows.data(), sides_.second, codes_.data());
}

template <typename Pixel>
void SharpnessRows<Pixel>::emit_wide() noexcept {
  Wide& columns = wide_columns_;
  if (sides_.second == 1) {
    sum_windows(columns.sums.data(), sides_.first, columns.windows.data());
  } else {
    sum_windows(columns.second_sums.data(), sides_.first, columns.fresh.data());
    sum_windows(columns.fresh.data(), sides_.second, columns.windows.data());
  }
  kernels_.root_code(columns.windows.data(), root_gain(code_, gradient_shift<Pixel>(operator_)), width_, codes_.data());
}

/// out[x] = the sum over `window` columns about x.
template <typename Pixel>
void SharpnessRows<Pixel>::sum_windows(const std::uint16_t* values, int window, std::uint16_t* out) const noexcept {
  const int radius = window / 2;
  if (width_ >= window) kernels_.window_sums_u16(values, window, width_, out + radius);
  sum_ends(values, width_, radius, out);
}
template <typename Pixel>
void SharpnessRows<Pixel>::sum_windows(const std::uint32_t* values, int window, std::uint32_t* out) const noexcept {
  const int radius = window / 2;
  if (width_ >= window) kernels_.window_sums_u32(values, window, width_, out + radius);
  sum_ends(values, width_, radius, out);
}

template <typename Pixel>
void SharpnessRows<Pixel>::find_clipped() noexcept {
  if (saturated_rows_ == 0) return;
  const std::uint16_t* counts = saturated_counts_.data();
  sum_windows(saturated_columns_.data(), window_, saturated_counts_.data());
  for (int x = 0; x < width_; ++x) {
    clipped_[static_cast<std::size_t>(x)] = counts[x] == 0 ? std::uint8_t{0} : levels_.of(counts[x]);
  }
}

template class SharpnessRows<std::uint8_t>;
template class SharpnessRows<std::uint16_t>;

}  // namespace fvd
