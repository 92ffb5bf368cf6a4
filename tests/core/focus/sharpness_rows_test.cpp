#include "core/focus/sharpness_rows.hpp"

#include <algorithm>
#include <random>
#include <vector>

#include "gtest/gtest.h"

namespace fvd {
namespace {

constexpr std::ptrdiff_t kPadding = 5;

/// An image in exactly as much memory as it needs, rows padded, pixels random up to full scale.
template <typename Pixel>
struct PaddedImage {
  PaddedImage(int width, int height, unsigned seed) : view{nullptr, width, height, width + kPadding} {
    std::mt19937 random(seed);
    std::uniform_int_distribution<int> level(0, sizeof(Pixel) == 1 ? 255 : 65535);
    storage.resize(static_cast<std::size_t>(view.row_stride * (height - 1) + width));
    for (auto& pixel : storage) pixel = static_cast<Pixel>(level(random));
    view.data = storage.data();
  }
  std::vector<Pixel> storage;
  PlaneView<Pixel> view;
};

template <typename Pixel>
class SharpnessRowsOf : public testing::Test {};
using Pixels = testing::Types<std::uint8_t, std::uint16_t>;
TYPED_TEST_SUITE(SharpnessRowsOf, Pixels);

constexpr PixelFormat format_of(std::uint8_t) { return PixelFormat::kMono8; }
constexpr PixelFormat format_of(std::uint16_t) { return PixelFormat::kMono16; }

TYPED_TEST(SharpnessRowsOf, LaplacianEqualsItsScalarLawForEveryWidth) {
  for (int width = 1; width <= 100; ++width) {
    const PaddedImage<TypeParam> image(width, 3, static_cast<unsigned>(width));
    std::vector<LaplacianOf<TypeParam>> expected(static_cast<std::size_t>(width), 0x5A);
    std::vector<LaplacianOf<TypeParam>> actual(static_cast<std::size_t>(width), 0xA5);
    for (int distance = 1; distance <= 7; ++distance) {
      modified_laplacian_row_scalar(image.view.row(0), image.view.row(1), image.view.row(2), width, distance,
                                    expected.data());
      modified_laplacian_row(image.view.row(0), image.view.row(1), image.view.row(2), width, distance, actual.data());
      ASSERT_EQ(expected, actual) << "width " << width << " distance " << distance;
    }
  }
}

TYPED_TEST(SharpnessRowsOf, EqualTheReferenceForEverySizeWindowAndStart) {
  for (const int width : {1, 2, 3, 4, 7, 8, 16, 31, 33, 64, 100}) {
    for (const int height : {1, 2, 3, 5, 9, 20}) {
      const PaddedImage<TypeParam> image(width, height, static_cast<unsigned>(width * 100 + height));
      for (const int window : {3, 5, 9, 31, 63}) {
        const int distance = 1 + (width + window) % 7;
        const auto expected = sharpness_reference(image_view(image.view, format_of(TypeParam{})), window, distance);
        SharpnessRows<TypeParam> rows(width, window, distance);
        for (const int first : {0, height / 2, height - 1}) {
          rows.begin(image.view, first, 1 << 17);
          for (int y = first; y < height; ++y) {
            rows.next();
            ASSERT_TRUE(std::equal(rows.sharpness(), rows.sharpness() + width, expected.row(y)))
                << width << " x " << height << " window " << window << " from row " << first << " at row " << y;
          }
        }
      }
    }
  }
}

TYPED_TEST(SharpnessRowsOf, MarkEveryWindowThatHoldsASaturatedPixel) {
  constexpr int kWidth = 40;
  constexpr int kHeight = 30;
  const int full = sizeof(TypeParam) == 1 ? 255 : 65535;
  PaddedImage<TypeParam> image(kWidth, kHeight, 3);
  for (auto& pixel : image.storage) pixel = static_cast<TypeParam>(std::min<int>(pixel, full - 1));
  image.view.at(0, 0) = static_cast<TypeParam>(full);
  image.view.at(20, 15) = static_cast<TypeParam>(full);
  SharpnessRows<TypeParam> rows(kWidth, 9, 1);
  for (const int first : {0, 14, 17}) {
    rows.begin(image.view, first, full);
    for (int y = first; y < kHeight; ++y) {
      rows.next();
      for (int x = 0; x < kWidth; ++x) {
        const bool expected = (x <= 4 && y <= 4) || (std::abs(x - 20) <= 4 && std::abs(y - 15) <= 4);
        ASSERT_EQ(rows.saturated()[x] != 0, expected) << x << ", " << y << " from row " << first;
      }
    }
  }
}

TEST(SharpnessReference, IsTheFormulaOnAKnownImage) {
  Plane<std::uint8_t> image(5, 5, 10);
  image.at(2, 2) = 20;  // one bright pixel: ML 40 there, 10 at its four neighbours
  const auto sums = sharpness_reference(image_view(image.view(), PixelFormat::kMono8), 3, 1);
  EXPECT_EQ(sums.at(2, 2), 80U);
  EXPECT_EQ(sums.at(0, 0), 0U + 0U + 0U + 0U);
  EXPECT_EQ(sums.at(1, 1), 40U + 10U + 10U);
}

TEST(SharpnessReference, LooksAtNeighboursAtItsDistance) {
  Plane<std::uint8_t> image(7, 7, 10);
  image.at(3, 3) = 20;  // ML 40 there, 10 three pixels up, down, left and right of it, nothing in between
  const auto sums = sharpness_reference(image_view(image.view(), PixelFormat::kMono8), 3, 3);
  EXPECT_EQ(sums.at(3, 3), 40U);
  EXPECT_EQ(sums.at(3, 0), 10U);
  EXPECT_EQ(sums.at(6, 3), 10U);
  EXPECT_EQ(sums.at(1, 1), 0U);
}

TEST(SharpnessReference, HoldsItsRangeAtFullContrast) {
  Plane<std::uint16_t> image(63, 63);
  for (int y = 0; y < 63; ++y) {
    for (int x = 0; x < 63; ++x) image.at(x, y) = (x + y) % 2 == 0 ? 65535 : 0;
  }
  const auto sums = sharpness_reference(image_view(image.view(), PixelFormat::kMono16), 63, 1);
  // Inside 4 * 65535; at the border the repeated edge halves one direction, in the corner both.
  EXPECT_EQ(sums.at(31, 31), 61U * 61U * 262140U + 4U * 61U * 196605U + 4U * 131070U);
}

}  // namespace
}  // namespace fvd
