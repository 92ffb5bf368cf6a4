#include "daemon/report/shaded_view.hpp"

#include <algorithm>
#include <limits>

#include <gtest/gtest.h>

#include "tests/daemon/report/sample_report.hpp"

namespace fvd {
namespace {

constexpr std::uint32_t kPaper = 0x00FFFFFF;

std::size_t painted(const ShadedView& view) {
  const auto& pixels = view.raster.pixels;
  return pixels.size() - static_cast<std::size_t>(std::count(pixels.begin(), pixels.end(), kPaper));
}

TEST(ShadedView, ExaggeratesByARoundFactorAndNeverReduces) {
  const Surface wide = test::groove_surface(160, 120, 2.0);
  const Surface narrow = test::groove_surface(160, 120, 0.1);

  // 0.3 x 320 um over 50 um, and 0.3 x 16 um over 50 um.
  EXPECT_DOUBLE_EQ(shaded_view(picture_surface(wide), 400, 300).frame.exaggeration, 1.0);
  EXPECT_DOUBLE_EQ(shaded_view(picture_surface(narrow), 400, 300).frame.exaggeration, 1.0);
  const Surface wider = test::groove_surface(160, 120, 6.0);
  EXPECT_DOUBLE_EQ(shaded_view(picture_surface(wider), 400, 300).frame.exaggeration, 5.0);
}

TEST(ShadedView, LooksFromTheFrontAndIsNotMirrored) {
  const Surface surface = test::groove_surface();
  const ViewFrame frame = shaded_view(picture_surface(surface), 400, 300).frame;
  const auto origin = frame.at(0.0, 0.0, frame.low_um);
  const auto right = frame.at(320.0, 0.0, frame.low_um);
  const auto front = frame.at(0.0, 240.0, frame.low_um);
  const auto up = frame.at(0.0, 0.0, frame.low_um + 50.0);

  EXPECT_GT(right.x, origin.x);
  EXPECT_GT(front.y, origin.y) << "the last row is in front";
  EXPECT_GT(front.depth, origin.depth);
  EXPECT_LT(up.y, origin.y);
  // Turning from right to front is clockwise on the page, as it is in the image.
  EXPECT_GT((right.x - origin.x) * (front.y - origin.y) - (right.y - origin.y) * (front.x - origin.x), 0.0);
}

TEST(ShadedView, ShowsPaperThroughHoles) {
  Surface surface = test::groove_surface();
  const std::size_t before = painted(shaded_view(picture_surface(surface), 400, 300));
  ASSERT_GT(before, 30000U);
  for (int y = 90; y < 115; ++y) {
    for (int x = 5; x < 35; ++x) surface.height_m.at(x, y) = std::numeric_limits<float>::quiet_NaN();
  }

  const std::size_t after = painted(shaded_view(picture_surface(surface), 400, 300));

  EXPECT_LT(after, before - 500);
  for (float& height : surface.height_m.pixels()) height = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(painted(shaded_view(picture_surface(surface), 400, 300)), 0U);
}

TEST(ShadedView, LightsTheSideThatLooksToTheLeft) {
  Surface surface = test::groove_surface(100, 60, 1.0);
  const auto ridge = [&surface] {
    for (int y = 0; y < 60; ++y) {
      for (int x = 0; x < 100; ++x) surface.height_m.at(x, y) = static_cast<float>((50 - std::abs(x - 50)) * 1e-6);
    }
  };
  ridge();
  ShadedView view = shaded_view(picture_surface(surface), 500, 400);
  const auto light_at = [&view](double x_um) {
    const auto place = view.frame.at(x_um, 30.0, 50.0 - std::abs(x_um - 50.5));
    const std::uint32_t rgb = view.raster.at(static_cast<int>(place.x), static_cast<int>(place.y));
    return (rgb >> 16U & 0xFFU) + (rgb >> 8U & 0xFFU) + (rgb & 0xFFU);
  };

  EXPECT_GT(light_at(40.5), light_at(60.5) + 50U);
}

}  // namespace
}  // namespace fvd
