#include "core/focus/measure/sharpness_rows.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <utility>
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

std::vector<std::pair<FocusOperator, FocusWindow>> operators_and_windows() {
  std::vector<std::pair<FocusOperator, FocusWindow>> all;
  for (const FocusOperator op : kAllFocusOperators) {
    for (const FocusWindow window : kAllFocusWindows) all.emplace_back(op, window);
  }
  return all;
}

TYPED_TEST(SharpnessRowsOf, EqualTheReferenceForEverySizeWindowOperatorAndStart) {
  for (const int width : {1, 2, 3, 4, 7, 8, 16, 31, 33, 64, 100}) {
    for (const int height : {1, 2, 3, 5, 9, 20}) {
      const PaddedImage<TypeParam> image(width, height, static_cast<unsigned>(width * 100 + height));
      const PixelFormat format = format_of(TypeParam{});
      for (const int window : {1, 3, 5, 9, 31, 63}) {
        for (const auto& [op, shape] : operators_and_windows()) {
          if (window == 1 && op != FocusOperator::kIntensity) continue;
          const FocusSettings settings{
              .focus_operator = op, .window = shape, .window_px = window, .distance_px = 1 + (width + window) % 7};
          const auto expected = sharpness_reference(image_view(image.view, format), settings);
          SharpnessRows<TypeParam> rows(width, settings, format);
          for (const int first : {0, height / 2, height - 1}) {
            rows.begin(image.view, first);
            for (int y = first; y < height; ++y) {
              rows.next();
              ASSERT_TRUE(std::equal(rows.codes(), rows.codes() + width, expected.row(y)))
                  << focus_operator_name(op) << ' ' << focus_window_name(shape) << ' ' << width << " x " << height
                  << " window " << window << " from row " << first << " at row " << y;
            }
          }
        }
      }
    }
  }
}

TYPED_TEST(SharpnessRowsOf, TellWhatShareOfEveryWindowIsAtFullScale) {
  constexpr int kWidth = 40;
  constexpr int kHeight = 30;
  const int full = sizeof(TypeParam) == 1 ? 255 : 65535;
  PaddedImage<TypeParam> image(kWidth, kHeight, 3);
  for (auto& pixel : image.storage) pixel = static_cast<TypeParam>(std::min<int>(pixel, full - 1));
  image.view.at(8, 8) = static_cast<TypeParam>(full);
  image.view.at(20, 15) = static_cast<TypeParam>(full);
  image.view.at(1, 28) = static_cast<TypeParam>(full);
  for (int y = 14; y < 24; ++y) {
    for (int x = 26; x < 36; ++x) image.view.at(x, y) = static_cast<TypeParam>(full);
  }
  SharpnessRows<TypeParam> rows(kWidth, {}, format_of(TypeParam{}));
  for (const int first : {0, 14, 17}) {
    rows.begin(image.view, first);
    for (int y = first; y < kHeight; ++y) {
      rows.next();
      bool any = false;
      for (int x = 0; x < kWidth; ++x) {
        const WindowReach columns(x, 4, kWidth);
        const WindowReach lines(y, 4, kHeight);
        int inside = 0;
        for (int v = lines.first; v <= lines.last; ++v) {
          for (int u = columns.first; u <= columns.last; ++u) inside += image.view.at(u, v) == full ? 1 : 0;
        }
        const int expected = inside > 56 ? 63 : static_cast<int>(std::ceil(62.0 * inside / 81.0));
        any = any || inside > 0;
        ASSERT_EQ(rows.clipped() == nullptr ? 0 : int{rows.clipped()[x]}, expected)
            << x << ", " << y << " from row " << first;
      }
    }
  }
}

/// A checkerboard is the strongest texture there is: the sum over a large window has more than 32 bits.
TYPED_TEST(SharpnessRowsOf, DoNotOverflowWhateverTheWindow) {
  constexpr int kSide = 90;
  PaddedImage<TypeParam> image(kSide, kSide, 1);
  const int full = sizeof(TypeParam) == 1 ? 255 : 65535;
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) image.view.at(x, y) = static_cast<TypeParam>((x + y) % 2 == 0 ? full : 0);
  }
  const PixelFormat format = format_of(TypeParam{});
  for (const auto& [op, factor] :
       {std::pair{FocusOperator::kModifiedLaplacian, 4}, std::pair{FocusOperator::kDiagonalLaplacian, 8}}) {
    for (const int window : {9, 17, 31, 63}) {
      const FocusSettings settings{
          .focus_operator = op, .window = FocusWindow::kBox, .window_px = window, .distance_px = 1};
      const SharpnessCode code = sharpness_code(settings, format);
      SharpnessRows<TypeParam> rows(kSide, settings, format);
      rows.begin(image.view, kSide / 2);
      rows.next();
      const double expected = static_cast<double>(factor) * full * window * window;
      EXPECT_NEAR(code.decode(rows.codes()[kSide / 2]) / expected, 1.0, 0.01)
          << focus_operator_name(op) << " window " << window;
    }
  }
}

/// F of the reference at a pixel.
double sharpness(const ImageView& image, const FocusSettings& settings, int x, int y) {
  return sharpness_code(settings, image.format).decode(sharpness_reference(image, settings).at(x, y));
}

FocusSettings modified_laplacian(int window_px, int distance_px) {
  return {.focus_operator = FocusOperator::kModifiedLaplacian,
          .window = FocusWindow::kBox,
          .window_px = window_px,
          .distance_px = distance_px};
}

TEST(SharpnessReference, IsTheModifiedLaplacianOnAKnownImage) {
  Plane<std::uint8_t> image(7, 7, 10);
  image.at(3, 3) = 20;  // ML 40 there, 10 at its four neighbours
  const FocusSettings settings = modified_laplacian(3, 1);
  const ImageView view = image_view(image.view(), PixelFormat::kMono8);
  EXPECT_EQ(sharpness(view, settings, 3, 3), 80.0);
  EXPECT_EQ(sharpness(view, settings, 2, 2), 40.0 + 10.0 + 10.0);
  EXPECT_EQ(sharpness(view, settings, 0, 0), 0.0);
}

TEST(SharpnessReference, SeesADiagonalLineThatTheModifiedLaplacianSeesLess) {
  Plane<std::uint8_t> image(15, 15, 10);
  image.at(7, 7) = 20;
  const FocusSettings settings{.focus_operator = FocusOperator::kDiagonalLaplacian, .window_px = 3, .distance_px = 2};
  const ImageView view = image_view(image.view(), PixelFormat::kMono8);
  // At the pixel itself twice two and four differences of 20; none of its eight neighbours sees it but the four
  // diagonal ones, by one difference of 10 each.
  EXPECT_EQ(sharpness(view, settings, 7, 7), 8 * 20.0 + 4 * 10.0);
  // Two pixels to the right: that one by twice 10, and the two beside it that are one pixel off diagonally.
  EXPECT_EQ(sharpness(view, settings, 9, 7), 2 * 10.0 + 2 * 10.0);
}

TEST(SharpnessReference, WeightsADoubleBoxTowardsItsMiddle) {
  Plane<std::uint8_t> image(41, 41, 10);
  image.at(20, 20) = 20;
  const FocusSettings doubled{
      .focus_operator = FocusOperator::kIntensity, .window = FocusWindow::kDoubleBox, .window_px = 9};
  const ImageView view = image_view(image.view(), PixelFormat::kMono8);
  const double background = sharpness(view, doubled, 5, 5);
  // Weights 5 in the middle, 5 two beside it, 1 at five; their sum is 35.
  const double unit = background / (35.0 * 35.0 * 10.0);
  EXPECT_NEAR((sharpness(view, doubled, 20, 20) - background) / unit, 25 * 10.0, 60.0);
  EXPECT_NEAR((sharpness(view, doubled, 22, 20) - background) / unit, 25 * 10.0, 60.0);
  EXPECT_NEAR((sharpness(view, doubled, 24, 20) - background) / unit, 10 * 10.0, 60.0);
  EXPECT_NEAR((sharpness(view, doubled, 26, 20) - background) / unit, 0.0, 60.0);
}

TEST(WindowSides, SpreadAsFarAsOneBox) {
  const auto sides = [](int window) { return window_sides({.window = FocusWindow::kDoubleBox, .window_px = window}); };
  EXPECT_EQ(sides(9).first, 7);
  EXPECT_EQ(sides(9).second, 5);
  EXPECT_EQ(sides(5).first, 3);
  EXPECT_EQ(sides(5).second, 3);
  for (int window = 3; window <= kMaxWindowPx; window += 2) {
    const WindowSides both = sides(window);
    EXPECT_LE(both.first * both.first + both.second * both.second, window * window + 1);
    EXPECT_GE(both.first, both.second);
    EXPECT_EQ(both.first % 2, 1);
    EXPECT_EQ(both.second % 2, 1);
  }
  EXPECT_DOUBLE_EQ(window_norm({.window = FocusWindow::kBox, .window_px = 9}), 9.0);
  EXPECT_DOUBLE_EQ(window_norm({.window = FocusWindow::kDoubleBox, .window_px = 9}), 135.0);
}

TEST(SharpnessReference, LooksAtNeighboursAtItsDistance) {
  Plane<std::uint8_t> image(9, 9, 10);
  image.at(4, 4) = 20;  // ML 40 there, 10 three pixels up, down, left and right of it, nothing in between
  const FocusSettings settings = modified_laplacian(3, 3);
  const ImageView view = image_view(image.view(), PixelFormat::kMono8);
  EXPECT_EQ(sharpness(view, settings, 4, 4), 40.0);
  EXPECT_EQ(sharpness(view, settings, 4, 1), 10.0);
  EXPECT_EQ(sharpness(view, settings, 2, 2), 0.0);
}

TEST(SharpnessReference, KeepsTheWindowCentredAtTheBorder) {
  for (const auto& [centre, first, last] : {std::array{0, 0, 2},
                                            {1, 0, 3},
                                            {2, 0, 4},
                                            {3, 0, 6},
                                            {4, 0, 8},
                                            {5, 1, 9},
                                            {16, 13, 19},
                                            {18, 16, 19},
                                            {19, 17, 19}}) {
    const WindowReach reach(centre, 4, 20);
    EXPECT_EQ(reach.first, first) << centre;
    EXPECT_EQ(reach.last, last) << centre;
  }
  const WindowReach whole(1, 31, 3);
  EXPECT_EQ(whole.first, 0);
  EXPECT_EQ(whole.last, 2);
}

TEST(SharpnessReference, IsTheSobelGradientSquared) {
  Plane<std::uint8_t> image(9, 9, 10);
  for (int y = 0; y < 9; ++y) {
    for (int x = 5; x < 9; ++x) image.at(x, y) = 30;  // a vertical edge: gx = 4 * 20 on both sides of it
  }
  const FocusSettings settings{.focus_operator = FocusOperator::kTenengrad, .window_px = 3, .distance_px = 1};
  const ImageView view = image_view(image.view(), PixelFormat::kMono8);
  EXPECT_NEAR(sharpness(view, settings, 4, 4), 2 * 3 * 6400.0, 40.0);
  EXPECT_EQ(sharpness(view, settings, 2, 4), 0.0);
}

TEST(SharpnessReference, IsTheGreyLevelItselfForTheIntensity) {
  Plane<std::uint16_t> image(5, 5, 700);
  image.at(2, 2) = 4000;
  const FocusSettings settings{.focus_operator = FocusOperator::kIntensity, .window_px = 1};
  const ImageView view = image_view(image.view(), PixelFormat::kMono12);
  EXPECT_NEAR(sharpness(view, settings, 2, 2), 4000.0, 1.0);
  EXPECT_NEAR(sharpness(view, settings, 0, 0), 700.0, 1.0);
}

TEST(SharpnessReference, HoldsItsRangeAtFullContrast) {
  Plane<std::uint16_t> wide(65, 65);
  Plane<std::uint8_t> narrow(65, 65);
  for (int y = 0; y < 65; ++y) {
    for (int x = 0; x < 65; ++x) {
      wide.at(x, y) = (x + y) % 2 == 0 ? 65535 : 0;
      narrow.at(x, y) = (x + y) % 2 == 0 ? 255 : 0;
    }
  }
  for (int window = 3; window <= 63; window += 2) {
    const FocusSettings settings = modified_laplacian(window, 1);
    const double area = window * window;
    const double expected_wide = area * 4 * 65535.0;
    EXPECT_NEAR(sharpness(image_view(wide.view(), PixelFormat::kMono16), settings, 32, 32), expected_wide,
                1e-3 * expected_wide)
        << window;
    EXPECT_NEAR(sharpness(image_view(narrow.view(), PixelFormat::kMono8), settings, 32, 32), area * 1020.0,
                1e-3 * area * 1020.0)
        << window;
  }
}

}  // namespace
}  // namespace fvd
