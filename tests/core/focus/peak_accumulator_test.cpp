#include "core/focus/peak_accumulator.hpp"

#include <algorithm>
#include <random>
#include <vector>

#include "gtest/gtest.h"

namespace fvd {
namespace {

/// One slice of a row; few distinct values, so that equal maxima are frequent, and now and then one of full range.
template <typename Texture>
struct SliceRow {
  SliceRow(int width, std::mt19937& random) {
    for (int x = 0; x < width; ++x) {
      const auto draw = static_cast<std::uint32_t>(random());
      sharpness.push_back(draw % 16 == 0 ? 0xFFFFFFF0U + draw / 16 % 16 : draw / 16 % 5);
      saturated.push_back(static_cast<std::uint8_t>(draw >> 31U));
      pixels.push_back(static_cast<Texture>(draw >> 8U));
    }
  }
  std::vector<std::uint32_t> sharpness;
  std::vector<std::uint8_t> saturated;
  std::vector<Texture> pixels;
};

template <typename Texture>
class APeakAccumulator : public testing::Test {};
using Textures = testing::Types<std::uint8_t, std::uint16_t>;
TYPED_TEST_SUITE(APeakAccumulator, Textures);

TYPED_TEST(APeakAccumulator, KeepsWhatTheWholeCurveSays) {
  std::mt19937 random(4);
  for (int width = 1; width <= 100; ++width) {
    PeakAccumulator<TypeParam> accumulator(width, 2);
    for (int y = 0; y < 2; ++y) {
      const auto row = accumulator.row(y);
      std::vector<SliceRow<TypeParam>> slices;
      for (int k = 0; k < 12; ++k) {
        const auto& slice = slices.emplace_back(width, random);
        if (k == 0) {
          start_peaks(row, slice.sharpness.data(), slice.saturated.data(), slice.pixels.data(), width);
        } else {
          update_peaks(row, slice.sharpness.data(), slice.saturated.data(), slice.pixels.data(), width, k);
        }
      }
      for (int x = 0; x < width; ++x) {
        const auto i = static_cast<std::size_t>(x);
        std::vector<std::uint32_t> curve;
        for (const auto& slice : slices) curve.push_back(slice.sharpness[i]);
        const auto peak = static_cast<std::size_t>(std::max_element(curve.begin(), curve.end()) - curve.begin());
        ASSERT_EQ(row.peak_index[x], peak) << "the first of equal maxima; width " << width << ", x " << x;
        ASSERT_EQ(row.peak[x], curve[peak]);
        ASSERT_EQ(row.left[x], peak > 0 ? curve[peak - 1] : 0);
        ASSERT_EQ(row.right[x], peak + 1 < curve.size() ? curve[peak + 1] : 0);
        ASSERT_EQ(row.minimum[x], *std::min_element(curve.begin(), curve.end()));
        ASSERT_EQ(row.previous[x], curve.back());
        ASSERT_EQ(row.texture[x], slices[peak].pixels[i]);
        ASSERT_EQ(row.saturated[x], slices[peak].saturated[i]);
      }
    }
  }
}

TEST(PeakAccumulator, TakesTheStatedBytesPerPixelWhereRowsFillTheirBlocks) {
  EXPECT_EQ(PeakAccumulator<std::uint8_t>::memory_bytes(2448, 2048), 24U * 2448 * 2048);
  EXPECT_EQ(PeakAccumulator<std::uint16_t>::memory_bytes(2048, 2048), 25U * 2048 * 2048);
  EXPECT_LE(PeakAccumulator<std::uint16_t>::memory_bytes(2449, 3), (25U * 2449 + 63) * 3);
}

}  // namespace
}  // namespace fvd
