#include "core/focus/measure/sharpness_rows.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace fvd {

namespace {

/// The bits a 16-bit gradient loses before it is squared; see the kernel.
template <typename Pixel>
constexpr int kGradientShift = sizeof(Pixel) == 1 ? 0 : 3;

/// The operator anywhere in the image; the law for the kernels and what they leave at the ends of a row.
template <typename Pixel>
std::uint32_t operator_value(FocusOperator op, const Pixel* above, const Pixel* row, const Pixel* below, int x,
                             int width, int distance, int shift) {
  const int left = std::max(x - distance, 0);
  const int right = std::min(x + distance, width - 1);
  switch (op) {
    case FocusOperator::kModifiedLaplacian:
      return static_cast<std::uint32_t>(std::abs(2 * row[x] - row[left] - row[right]) +
                                        std::abs(2 * row[x] - above[x] - below[x]));
    case FocusOperator::kTenengrad: {
      const int gx = (above[right] + 2 * row[right] + below[right] - above[left] - 2 * row[left] - below[left]) >>
                     kGradientShift<Pixel>;
      const int gy = (below[left] + 2 * below[x] + below[right] - above[left] - 2 * above[x] - above[right]) >>
                     kGradientShift<Pixel>;
      return static_cast<std::uint32_t>(gx * gx + gy * gy) >> shift;
    }
    case FocusOperator::kIntensity:
      return row[x];
  }
  return 0;
}

std::uint16_t linear_code(std::uint64_t column_sum, int shift) {
  return static_cast<std::uint16_t>(shift == 0 ? column_sum : (column_sum + (1U << (shift - 1))) >> shift);
}

/// The root kernel's arithmetic, in its order and precision.
std::uint16_t root_code(std::uint64_t sum, float gain) {
  const float root = std::sqrt(static_cast<float>(static_cast<std::int32_t>(sum)));
  // As the kernel rounds, whose values are not negative. NOLINTNEXTLINE(bugprone-incorrect-roundings)
  return static_cast<std::uint16_t>(static_cast<std::int32_t>(gain * root + 0.5F));
}

float root_gain(const SharpnessCode& code, int gradient_shift) {
  // The sums lack the bits that were shifted out of their values.
  return static_cast<float>(code.gain * std::sqrt(std::ldexp(1.0, code.operator_shift + 2 * gradient_shift)));
}

template <typename Pixel>
int gradient_shift(FocusOperator op) {
  return op == FocusOperator::kTenengrad ? kGradientShift<Pixel> : 0;
}

template <typename Pixel>
Plane<std::uint16_t> reference(PlaneView<const Pixel> image, const FocusSettings& settings, const SharpnessCode& code) {
  Plane<std::uint32_t> values(image.width, image.height);
  for (int y = 0; y < image.height; ++y) {
    const Pixel* above = image.row(std::max(y - settings.distance_px, 0));
    const Pixel* below = image.row(std::min(y + settings.distance_px, image.height - 1));
    for (int x = 0; x < image.width; ++x) {
      values.at(x, y) = operator_value(settings.focus_operator, above, image.row(y), below, x, image.width,
                                       settings.distance_px, code.operator_shift);
    }
  }
  Plane<std::uint16_t> codes(image.width, image.height);
  const int radius = settings.window_px / 2;
  const float gain = root_gain(code, gradient_shift<Pixel>(settings.focus_operator));
  for (int y = 0; y < image.height; ++y) {
    const WindowReach rows(y, radius, image.height);
    for (int x = 0; x < image.width; ++x) {
      const WindowReach columns(x, radius, image.width);
      std::uint64_t sum = 0;
      for (int u = columns.first; u <= columns.last; ++u) {
        std::uint64_t column = 0;
        for (int v = rows.first; v <= rows.last; ++v) column += values.at(u, v);
        sum += code.root ? column : linear_code(column, code.shift);
      }
      codes.at(x, y) = code.root ? root_code(sum, gain) : static_cast<std::uint16_t>(sum);
    }
  }
  return codes;
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
      window_(settings.window_px),
      radius_(settings.window_px / 2),
      distance_(settings.distance_px),
      operator_(settings.focus_operator),
      code_(sharpness_code(settings, format)),
      saturation_(max_grey_level(format)),
      narrow_(!code_.root),
      codes_(static_cast<std::size_t>(width)),
      saturated_columns_(static_cast<std::size_t>(width)),
      saturated_counts_(static_cast<std::size_t>(width)),
      saturated_(static_cast<std::size_t>(width)) {
  if (narrow_) {
    resize(narrow_columns_);
  } else {
    resize(wide_columns_);
  }
}

template <typename Pixel>
template <typename Sum>
void SharpnessRows<Pixel>::resize(Columns<Sum>& columns) {
  const auto width = static_cast<std::size_t>(width_);
  columns.ring.resize(width * static_cast<std::size_t>(window_));
  for (auto* row : {&columns.fresh, &columns.sums, &columns.scaled, &columns.windows}) row->resize(width);
}

template <typename Pixel>
std::size_t SharpnessRows<Pixel>::memory_bytes(int width, int window) {
  return static_cast<std::size_t>(width) *
         ((static_cast<std::size_t>(window) + 4) * sizeof(std::uint32_t) + 3 * sizeof(std::uint16_t) + 1);
}

template <typename Pixel>
bool SharpnessRows<Pixel>::row_saturated(int y) const noexcept {
  if constexpr (sizeof(Pixel) == 1) return kernels_.maximum_u8(image_.row(y), width_) >= saturation_;
  if constexpr (sizeof(Pixel) == 2) return kernels_.maximum_u16(image_.row(y), width_) >= saturation_;
}

template <typename Pixel>
template <typename Sum>
void SharpnessRows<Pixel>::clear(Columns<Sum>& columns) noexcept {
  std::fill(columns.ring.begin(), columns.ring.end(), Sum{0});
  std::fill(columns.sums.begin(), columns.sums.end(), Sum{0});
}

template <typename Pixel>
void SharpnessRows<Pixel>::begin(PlaneView<const Pixel> image, int first) noexcept {
  image_ = image;
  y_ = first;
  saturated_rows_ = 0;
  if (narrow_) {
    clear(narrow_columns_);
  } else {
    clear(wide_columns_);
  }
  std::fill(saturated_columns_.begin(), saturated_columns_.end(), std::uint16_t{0});
  low_ = WindowReach(first, radius_, image.height).first;
  high_ = low_;
}

template <typename Pixel>
void SharpnessRows<Pixel>::compute_row(int y, std::uint32_t* out) noexcept {
  const Pixel* above = image_.row(std::max(y - distance_, 0));
  const Pixel* row = image_.row(y);
  const Pixel* below = image_.row(std::min(y + distance_, image_.height - 1));
  if (operator_ == FocusOperator::kIntensity) {
    std::copy_n(row, width_, out);
    return;
  }
  if constexpr (sizeof(Pixel) == 1) {
    kernels_.tenengrad_u8(above, row, below, width_, distance_, code_.operator_shift, out);
  } else if (operator_ == FocusOperator::kTenengrad) {
    kernels_.tenengrad_u16(above, row, below, width_, distance_, code_.operator_shift, out);
  } else {
    kernels_.laplacian_u16(above, row, below, width_, distance_, out);
  }
  for_ends([&](int x) {
    out[x] = operator_value(operator_, above, row, below, x, width_, distance_, code_.operator_shift);
  });
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
    // The slot holds the row that leaves, `window` rows above, or zeros.
    std::uint16_t* slot = columns.ring.data() + static_cast<std::ptrdiff_t>(y % window_) * width_;
    const Pixel* above = image_.row(std::max(y - distance_, 0));
    const Pixel* row = image_.row(y);
    const Pixel* below = image_.row(std::min(y + distance_, image_.height - 1));
    prefetch_row(y + 1 + distance_);
    kernels_.enter_laplacian_u8(above, row, below, width_, distance_, code_.shift, columns.sums.data(), slot,
                                columns.scaled.data());
    for_ends([&](int x) {
      const auto column = static_cast<std::size_t>(x);
      const auto value =
          static_cast<std::uint16_t>(operator_value(operator_, above, row, below, x, width_, distance_, 0));
      columns.sums[column] = static_cast<std::uint16_t>(columns.sums[column] + value - slot[x]);
      slot[x] = value;
      columns.scaled[column] = linear_code(columns.sums[column], code_.shift);
    });
  }
}

template <typename Pixel>
void SharpnessRows<Pixel>::enter(Wide& columns, int y) noexcept {
  compute_row(y, columns.fresh.data());
  std::uint32_t* slot = columns.ring.data() + static_cast<std::ptrdiff_t>(y % window_) * width_;
  kernels_.slide_u32(columns.sums.data(), columns.fresh.data(), slot, width_);
}

template <typename Pixel>
void SharpnessRows<Pixel>::leave(Narrow& columns, int y) noexcept {
  std::uint16_t* slot = columns.ring.data() + static_cast<std::ptrdiff_t>(y % window_) * width_;
  for (int x = 0; x < width_; ++x) {
    const auto column = static_cast<std::size_t>(x);
    columns.sums[column] = static_cast<std::uint16_t>(columns.sums[column] - slot[x]);
    columns.scaled[column] = linear_code(columns.sums[column], code_.shift);
    slot[x] = 0;
  }
}

template <typename Pixel>
void SharpnessRows<Pixel>::leave(Wide& columns, int y) noexcept {
  std::uint32_t* slot = columns.ring.data() + static_cast<std::ptrdiff_t>(y % window_) * width_;
  std::fill(columns.fresh.begin(), columns.fresh.end(), 0U);
  kernels_.slide_u32(columns.sums.data(), columns.fresh.data(), slot, width_);
}

template <typename Pixel>
void SharpnessRows<Pixel>::count_saturated(int y, int change) noexcept {
  if (change < 0 && saturated_rows_ == 0) return;
  if (!row_saturated(y)) return;
  saturated_rows_ += change;
  const Pixel* pixels = image_.row(y);
  for (int x = 0; x < width_; ++x) {
    auto& column = saturated_columns_[static_cast<std::size_t>(x)];
    column = static_cast<std::uint16_t>(column + (pixels[x] >= saturation_ ? change : 0));
  }
}

template <typename Pixel>
void SharpnessRows<Pixel>::enter(int y) noexcept {
  if (narrow_) {
    enter(narrow_columns_, y);
  } else {
    enter(wide_columns_, y);
  }
  count_saturated(y, 1);
  if (y - window_ < low_) return;
  count_saturated(low_, -1);  // its slot was taken over
  ++low_;
}

template <typename Pixel>
void SharpnessRows<Pixel>::leave(int y) noexcept {
  if (narrow_) {
    leave(narrow_columns_, y);
  } else {
    leave(wide_columns_, y);
  }
  count_saturated(y, -1);
}

template <typename Pixel>
void SharpnessRows<Pixel>::next() noexcept {
  const WindowReach reach(y_, radius_, image_.height);
  while (high_ <= reach.last) enter(high_++);
  while (low_ < reach.first) leave(low_++);
  if (narrow_) {
    emit_narrow();
  } else {
    emit_wide();
  }
  find_saturated();
  ++y_;
}

template <typename Pixel>
void SharpnessRows<Pixel>::emit_narrow() noexcept {
  Narrow& columns = narrow_columns_;
  if (width_ >= window_) {
    kernels_.window_sums_u16(columns.scaled.data(), window_, width_, codes_.data() + radius_);
  }
  sum_ends(columns.scaled.data(), width_, radius_, codes_.data());
}

template <typename Pixel>
void SharpnessRows<Pixel>::emit_wide() noexcept {
  Wide& columns = wide_columns_;
  if (width_ >= window_) {
    kernels_.window_sums_u32(columns.sums.data(), window_, width_, columns.windows.data() + radius_);
  }
  sum_ends(columns.sums.data(), width_, radius_, columns.windows.data());
  kernels_.root_code(columns.windows.data(), root_gain(code_, gradient_shift<Pixel>(operator_)), width_, codes_.data());
}

template <typename Pixel>
void SharpnessRows<Pixel>::find_saturated() noexcept {
  if (saturated_rows_ == 0) {
    if (!saturated_clear_) std::fill(saturated_.begin(), saturated_.end(), std::uint8_t{0});
    saturated_clear_ = true;
    return;
  }
  saturated_clear_ = false;
  std::uint16_t* counts = saturated_counts_.data();
  if (width_ >= window_) {
    kernels_.window_sums_u16(saturated_columns_.data(), window_, width_, counts + radius_);
  }
  sum_ends(saturated_columns_.data(), width_, radius_, counts);
  for (int x = 0; x < width_; ++x) saturated_[static_cast<std::size_t>(x)] = counts[x] > 0 ? 1 : 0;
}

Plane<std::uint16_t> sharpness_reference(const ImageView& image, const FocusSettings& settings) {
  const SharpnessCode code = sharpness_code(settings, image.format);
  return image.format == PixelFormat::kMono8 ? reference(image.as<std::uint8_t>(), settings, code)
                                             : reference(image.as<std::uint16_t>(), settings, code);
}

template class SharpnessRows<std::uint8_t>;
template class SharpnessRows<std::uint16_t>;

}  // namespace fvd
