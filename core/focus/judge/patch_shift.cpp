#include "core/focus/judge/patch_shift.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace fvd {

namespace {

constexpr int kMaxColumns = 3;
constexpr int kMaxRegion_px = 124;  // that a patch is filtered from
constexpr int kMinRegion_px = 64;
constexpr int kUsualRegion_px = 108;  // fewer columns rather than smaller patches
constexpr int kBlurReach_px = 3;
constexpr int kDifference_px = 5;
constexpr int kReach_px = kBlurReach_px + kDifference_px;
constexpr int kMargin_px = kMaxPatchShift_px + 1;  // and the neighbours of the farthest shift
constexpr int kSpan = 2 * kMargin_px + 1;
constexpr double kLeastCorrelation = 0.4;

/// A box of 5 and a box of 3, one after the other; their sum is 15.
template <typename Value>
std::int32_t blurred(const Value* at, std::ptrdiff_t step) noexcept {
  return at[-3 * step] + at[3 * step] + 2 * (at[-2 * step] + at[2 * step]) + 3 * (at[-step] + at[0] + at[step]);
}

/// Filters the region whose upper left pixel is (left, top). Values of 16 bits: 8 x 225 x 65535 fits 32 bits.
template <typename Pixel>
std::vector<std::int16_t> filtered(PlaneView<const Pixel> image, int left, int top, int region, int shift_bits) {
  const int blurred_side = region - 2 * kBlurReach_px;
  const int side = region - 2 * kReach_px;
  const auto size = [](int width, int height) {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  };
  std::vector<std::int32_t> along(size(blurred_side, region));
  for (int y = 0; y < region; ++y) {
    const Pixel* const row = image.row(top + y) + left + kBlurReach_px;
    std::int32_t* const out = along.data() + static_cast<std::ptrdiff_t>(y) * blurred_side;
    for (int x = 0; x < blurred_side; ++x) out[x] = blurred(row + x, 1);
  }
  std::vector<std::int32_t> blur(size(blurred_side, blurred_side));
  for (int y = 0; y < blurred_side; ++y) {
    const std::int32_t* const row = along.data() + static_cast<std::ptrdiff_t>(y + kBlurReach_px) * blurred_side;
    std::int32_t* const out = blur.data() + static_cast<std::ptrdiff_t>(y) * blurred_side;
    for (int x = 0; x < blurred_side; ++x) out[x] = blurred(row + x, blurred_side);
  }
  std::vector<std::int16_t> values(size(side, side));
  const std::int32_t half = 1 << (shift_bits - 1);
  const std::ptrdiff_t down = static_cast<std::ptrdiff_t>(kDifference_px) * blurred_side;
  for (int y = 0; y < side; ++y) {
    const std::int32_t* const row =
        blur.data() + static_cast<std::ptrdiff_t>(y + kDifference_px) * blurred_side + kDifference_px;
    std::int16_t* const out = values.data() + static_cast<std::ptrdiff_t>(y) * side;
    for (int x = 0; x < side; ++x) {
      const std::int32_t difference =
          4 * row[x] - row[x - kDifference_px] - row[x + kDifference_px] - row[x - down] - row[x + down];
      out[x] = static_cast<std::int16_t>((difference + half) >> shift_bits);
    }
  }
  return values;
}

/// The correlation of the middle of a patch with the other patch, by shift.
class Correlations {
 public:
  Correlations(const std::vector<std::int16_t>& before, const std::vector<std::int16_t>& after, int side)
      : before_(before), after_(after), side_(side), inner_(side - 2 * kMargin_px) {
    known_.fill(-2.0);
  }

  [[nodiscard]] double at(int dx, int dy) {
    double& value = known_[static_cast<std::size_t>((dy + kMargin_px) * kSpan + dx + kMargin_px)];
    if (value < -1.5) value = correlation(dx, dy, 1);
    return value;
  }

  /// The best of every second shift, by every second row.
  void coarse(int& best_x, int& best_y) const {
    double best = -2.0;
    for (int dy = -kMaxPatchShift_px + 1; dy < kMaxPatchShift_px; dy += 2) {
      for (int dx = -kMaxPatchShift_px + 1; dx < kMaxPatchShift_px; dx += 2) {
        const double value = correlation(dx, dy, 2);
        if (value <= best) continue;
        best = value;
        best_x = dx;
        best_y = dy;
      }
    }
  }

  /// Moves to the best shift nearby. False at the limit of the search.
  [[nodiscard]] bool climb(int& x, int& y) {
    for (;;) {
      if (std::max(std::abs(x), std::abs(y)) > kMaxPatchShift_px) return false;
      int best_x = x;
      int best_y = y;
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
          if (at(x + dx, y + dy) <= at(best_x, best_y)) continue;
          best_x = x + dx;
          best_y = y + dy;
        }
      }
      if (best_x == x && best_y == y) return true;
      x = best_x;
      y = best_y;
    }
  }

 private:
  /// Sums of a row fit 32 bits: values of 12 bits, at most 96 of them.
  [[nodiscard]] double correlation(int dx, int dy, int row_step) const noexcept {
    std::int64_t product = 0;
    std::int64_t square_before = 0;
    std::int64_t square_after = 0;
    for (int y = 0; y < inner_; y += row_step) {
      const std::int16_t* const a = before_.data() + static_cast<std::ptrdiff_t>(y + kMargin_px) * side_ + kMargin_px;
      const std::int16_t* const b =
          after_.data() + static_cast<std::ptrdiff_t>(y + kMargin_px + dy) * side_ + kMargin_px + dx;
      std::int32_t ab = 0;
      std::int32_t aa = 0;
      std::int32_t bb = 0;
      for (int x = 0; x < inner_; ++x) {
        ab += a[x] * b[x];
        aa += a[x] * a[x];
        bb += b[x] * b[x];
      }
      product += ab;
      square_before += aa;
      square_after += bb;
    }
    if (square_before == 0 || square_after == 0) return 0.0;
    return static_cast<double>(product) /
           std::sqrt(static_cast<double>(square_before) * static_cast<double>(square_after));
  }

  const std::vector<std::int16_t>& before_;
  const std::vector<std::int16_t>& after_;
  int side_;
  int inner_;
  std::array<double, static_cast<std::size_t>(kSpan) * kSpan> known_{};
};

/// The vertex of a quadratic through the logarithms about the best shift: the correlation of blurred texture is like a
/// bell, of any direction.
std::optional<PatchShift> vertex(Correlations& correlations, int x, int y) {
  const double best = correlations.at(x, y);
  const auto level = [&](int dx, int dy) { return std::log(std::max(correlations.at(x + dx, y + dy), 0.05 * best)); };
  const double middle = std::log(best);
  const double slope_x = 0.5 * (level(1, 0) - level(-1, 0));
  const double slope_y = 0.5 * (level(0, 1) - level(0, -1));
  const double bend_xx = 2.0 * middle - level(1, 0) - level(-1, 0);
  const double bend_yy = 2.0 * middle - level(0, 1) - level(0, -1);
  const double bend_xy = 0.25 * (level(1, -1) + level(-1, 1) - level(1, 1) - level(-1, -1));
  const double determinant = bend_xx * bend_yy - bend_xy * bend_xy;
  if (!(bend_xx > 0.0 && determinant > 1e-3 * bend_xx * bend_yy)) return std::nullopt;
  const double offset_x = (bend_yy * slope_x - bend_xy * slope_y) / determinant;
  const double offset_y = (bend_xx * slope_y - bend_xy * slope_x) / determinant;
  const double weight = best * best / (1.0 - best * best + 1e-3);
  return PatchShift{x + std::clamp(offset_x, -1.0, 1.0), y + std::clamp(offset_y, -1.0, 1.0), weight * bend_xx,
                    weight * bend_xy, weight * bend_yy};
}

}  // namespace

SlicePatches slice_patches(const ImageView& slice) {
  const int columns = std::clamp(slice.width / kUsualRegion_px, 1, kMaxColumns);
  const int rows = std::clamp(slice.height / kUsualRegion_px, 1, kMaxColumns);
  const int region = std::min({kMaxRegion_px, slice.width / columns, slice.height / rows});
  if (region < kMinRegion_px) return {};
  SlicePatches patches;
  patches.side = region - 2 * kReach_px;
  const int bits = significant_bits(slice.format);
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const int left = (2 * column + 1) * slice.width / (2 * columns) - region / 2;
      const int top = (2 * row + 1) * slice.height / (2 * rows) - region / 2;
      patches.values.push_back(slice.format == PixelFormat::kMono8
                                   ? filtered(slice.as<std::uint8_t>(), left, top, region, bits)
                                   : filtered(slice.as<std::uint16_t>(), left, top, region, bits));
      patches.x_px.push_back(left + 0.5 * (region - slice.width));
      patches.y_px.push_back(top + 0.5 * (region - slice.height));
    }
  }
  return patches;
}

std::optional<PatchShift> patch_shift(const std::vector<std::int16_t>& before, const std::vector<std::int16_t>& after,
                                      int side, int guess_x, int guess_y) {
  Correlations correlations(before, after, side);
  int x = std::clamp(guess_x, -kMaxPatchShift_px, kMaxPatchShift_px);
  int y = std::clamp(guess_y, -kMaxPatchShift_px, kMaxPatchShift_px);
  const auto good = [&] { return correlations.climb(x, y) && correlations.at(x, y) >= kLeastCorrelation; };
  if (!good()) {
    correlations.coarse(x, y);
    if (!good()) return std::nullopt;
  }
  return vertex(correlations, x, y);
}

}  // namespace fvd
