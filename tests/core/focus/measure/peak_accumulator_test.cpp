#include "core/focus/measure/peak_accumulator.hpp"

#include <algorithm>
#include <random>
#include <utility>
#include <vector>

#include <sys/mman.h>

#include "core/focus/measure/slice_binner.hpp"
#include "gtest/gtest.h"

namespace fvd {
namespace {

/// One slice of a row; few distinct values, so that equal maxima are frequent, and now and then one of full range.
template <typename Texture>
struct SliceRow {
  SliceRow(int width, std::mt19937& random) {
    for (int x = 0; x < width; ++x) {
      const auto draw = static_cast<std::uint32_t>(random());
      codes.push_back(static_cast<std::uint16_t>(draw % 16 == 0 ? 0xFFF0U + draw / 16 % 16 : draw / 16 % 5 * 64));
      const std::uint32_t level = random() % 3 == 0 ? draw >> 28U : draw >> 26U;
      clipped.push_back(static_cast<std::uint8_t>(draw % 7 < 3 ? 0U : level));
      pixels.push_back(static_cast<Texture>(draw >> 8U));
    }
  }
  std::vector<std::uint16_t> codes;
  std::vector<std::uint8_t> clipped;
  std::vector<Texture> pixels;
};

template <typename Texture>
class APeakAccumulator : public testing::Test {};
using Textures = testing::Types<std::uint8_t, std::uint16_t>;
TYPED_TEST_SUITE(APeakAccumulator, Textures);

TYPED_TEST(APeakAccumulator, KeepsWhatTheWholeCurveSays) {
  std::mt19937 random(4);
  for (int width = 1; width <= 100; ++width) {
    PeakAccumulator<TypeParam> accumulator(width, 2, {});
    SliceBinner<TypeParam> binner(width, 1);
    for (int y = 0; y < 2; ++y) {
      const auto row = accumulator.row(y);
      std::vector<SliceRow<TypeParam>> slices;
      for (int k = 0; k < 12; ++k) {
        const auto& slice = slices.emplace_back(width, random);
        const Sample<TypeParam> sample{slice.codes.data(), slice.clipped.data(), slice.pixels.data()};
        binner.add(row, std::span(&sample, 1), k);
      }
      for (int x = 0; x < width; ++x) {
        const auto i = static_cast<std::size_t>(x);
        std::vector<std::uint16_t> curve;
        for (const auto& slice : slices) curve.push_back(slice.codes[i]);
        const auto peak = static_cast<std::size_t>(std::max_element(curve.begin(), curve.end()) - curve.begin());
        const auto at = [&](std::size_t index) { return index < curve.size() ? curve[index] : std::uint16_t{0}; };
        ASSERT_EQ(row.curve.peak_index[x], peak) << "the first of equal maxima; width " << width << ", x " << x;
        ASSERT_EQ(row.curve.peak[x], curve[peak]);
        ASSERT_EQ(row.curve.left[x], at(peak - 1));
        ASSERT_EQ(row.curve.left2[x], at(peak - 2));
        ASSERT_EQ(row.curve.right[x], at(peak + 1));
        ASSERT_EQ(row.curve.right2[x], at(peak + 2));
        ASSERT_EQ(row.curve.minimum[x], *std::min_element(curve.begin(), curve.end()));
        ASSERT_EQ(row.curve.previous[x], curve.back());
        ASSERT_EQ(row.texture[x], slices[peak].pixels[i]);
        if (peak == 0 || peak + 1 == curve.size()) continue;  // a hole anyway
        const auto level = [&](std::size_t index) { return int{slices[index].clipped[i]}; };
        const int before = level(peak - 1) - level(peak);
        const int after = level(peak + 1) - level(peak);
        int known = level(peak) == 0 ? 0 : level(peak) < 22 ? clipping::kSome : clipping::kMany;
        if (before > 3 || after > 3 || before * after < 0 || level(peak) == 63) known = clipping::kNoPeak;
        ASSERT_EQ(row.curve.clipped[x] & clipping::kPeakBits, known)
            << "level " << level(peak) << ", beside it " << before << " and " << after << " more";
      }
    }
  }
}

/// The second peak of a curve whose valleys lie below half of its peak.
int second_peak_of(const std::vector<std::uint16_t>& curve) {
  PeakAccumulator<std::uint8_t> accumulator(1, 1, {.valley_share = 32768});
  SliceBinner<std::uint8_t> binner(1, 1);
  const auto row = accumulator.row(0);
  const std::uint8_t pixel = 0;
  for (std::size_t k = 0; k < curve.size(); ++k) {
    const Sample<std::uint8_t> sample{&curve[k], nullptr, &pixel};
    binner.add(row, std::span(&sample, 1), static_cast<int>(k));
  }
  return second_peak::sharpness(*row.curve.second);
}

TEST(PeakAccumulator, KeepsTheHighestSampleBeyondAValley) {
  EXPECT_EQ(second_peak_of({10, 1000, 10, 10, 10, 900, 10}), 900);
  EXPECT_EQ(second_peak_of({10, 900, 10, 10, 10, 1000, 10}), 900);
  EXPECT_EQ(second_peak_of({10, 1000, 10, 10, 10, 1000, 10}), 1000) << "of equal ones the first is the peak";
  EXPECT_EQ(second_peak_of({10, 1000, 499, 600, 700, 900, 10}), 900) << "a valley of one sample";
  EXPECT_EQ(second_peak_of({10, 1000, 500, 600, 700, 900}), 0) << "not below half";
  EXPECT_EQ(second_peak_of({10, 1000, 980, 960, 940, 930, 920, 910, 900}), 0) << "a slow flank";
  EXPECT_EQ(second_peak_of({900, 910, 920, 930, 940, 960, 980, 1000}), 0);
  EXPECT_EQ(second_peak_of({10, 1000, 10, 10, 900, 10, 800, 10}), 800) << "three samples away is too near";
  EXPECT_EQ(second_peak_of({10, 900, 10, 10, 1000, 10}), 0);
  EXPECT_EQ(second_peak_of({900, 10, 10, 10, 950, 10, 10, 10, 1000}), 950) << "the higher of two";
  EXPECT_EQ(second_peak_of({900, 10, 10, 10, 1000, 10, 10, 10, 950}), 950);
  EXPECT_EQ(second_peak_of({950, 10, 10, 10, 1000, 10, 10, 10, 900}), 950);
  EXPECT_EQ(second_peak_of({900, 10, 10, 10, 500, 800, 950, 1000}), 900) << "a flank that overtakes is the peak's own";
  EXPECT_EQ(second_peak_of({10, 65000, 10, 10, 10, 65535, 10}), 65000);
}

TYPED_TEST(APeakAccumulator, SumsTheSlicesOfABin) {
  constexpr int kWidth = 37;
  std::mt19937 random(5);
  for (const int bin : {2, 3, 4, 7}) {
    PeakAccumulator<TypeParam> accumulator(kWidth, 1, {.bins = true});
    SliceBinner<TypeParam> binner(kWidth, bin);
    const auto row = accumulator.row(0);
    std::vector<SliceRow<TypeParam>> slices;
    for (int k = 0; k < 3 * bin; ++k) {
      const auto& slice = slices.emplace_back(kWidth, random);
      const Sample<TypeParam> sample{slice.codes.data(), slice.clipped.data(), slice.pixels.data()};
      binner.add(row, std::span(&sample, 1), k);
    }
    const int shift = bin_shift(bin);
    for (int x = 0; x < kWidth; ++x) {
      std::vector<unsigned> sums(3);
      for (int k = 0; k < 3 * bin; ++k) {
        sums[static_cast<std::size_t>(k / bin)] +=
            (slices[static_cast<std::size_t>(k)].codes[static_cast<std::size_t>(x)] + (1U << (shift - 1))) >> shift;
      }
      const auto peak = std::max_element(sums.begin(), sums.end()) - sums.begin();
      ASSERT_EQ(row.curve.peak_index[x], peak) << bin;
      ASSERT_EQ(row.curve.peak[x], *std::max_element(sums.begin(), sums.end()));
      ASSERT_EQ(row.curve.minimum[x], *std::min_element(sums.begin(), sums.end()));
      const auto middle = static_cast<std::size_t>(peak * bin + (bin - 1) / 2);
      ASSERT_EQ(row.texture[x], slices[middle].pixels[static_cast<std::size_t>(x)]);
    }
  }
}

/// Pages of the state that no memory stands behind.
std::ptrdiff_t missing_pages(PeakAccumulator<std::uint8_t>& accumulator) {
  std::vector<unsigned char> resident((accumulator.memory_bytes() + 4095) / 4096);
  EXPECT_EQ(::mincore(accumulator.row(0).curve.previous, accumulator.memory_bytes(), resident.data()), 0);
  return std::count_if(resident.begin(), resident.end(), [](unsigned char page) { return (page & 1U) == 0; });
}

TEST(PeakAccumulator, HasItsPagesBeforeTheFirstSlice) {
  PeakAccumulator<std::uint8_t> accumulator(1001, 700, {});  // rows end within pages
  ASSERT_GT(missing_pages(accumulator), 0);
  accumulator.touch_rows(0, 0);
  for (const auto& [first, end] : {std::pair(0, 233), std::pair(233, 466), std::pair(466, 700)}) {
    accumulator.touch_rows(first, end);
  }
  EXPECT_EQ(missing_pages(accumulator), 0);
}

TEST(PeakAccumulator, TakesTheStatedBytesPerPixelWhereRowsFillTheirBlocks) {
  EXPECT_EQ(PeakAccumulator<std::uint8_t>::memory_bytes(2448, 2048, {}), 20U * 2448 * 2048);
  EXPECT_EQ(PeakAccumulator<std::uint8_t>::memory_bytes(2448, 2048, {.bins = true}), 24U * 2448 * 2048);
  EXPECT_EQ(PeakAccumulator<std::uint8_t>::memory_bytes(2448, 2048, {.bins = true, .valley_share = 1}),
            26U * 2448 * 2048);
  EXPECT_EQ(PeakAccumulator<std::uint16_t>::memory_bytes(2048, 2048, {}), 21U * 2048 * 2048);
  EXPECT_EQ(PeakAccumulator<std::uint16_t>::memory_bytes(2048, 2048, {.bins = true}), 26U * 2048 * 2048);
}

}  // namespace
}  // namespace fvd
