#include "core/focus/drift_undo.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace fvd {
namespace {

Plane<std::uint8_t> counted() {
  Plane<std::uint8_t> image = Plane<std::uint8_t>::unset(5, 4);
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 5; ++x) image.at(x, y) = static_cast<std::uint8_t>(10 * y + x);
  }
  return image;
}

TEST(DriftUndo, LeavesSlicesOfLessThanHalfAPixelWhereTheyAre) {
  const Plane<std::uint8_t> image = counted();
  std::vector<ZSlice> batch{{image_view(image.view(), PixelFormat::kMono8), 4.0}};
  DriftUndo undo(DriftPath(0.1, -0.1, 0.0));

  undo.apply(batch);

  EXPECT_EQ(batch[0].image.data, image_view(image.view(), PixelFormat::kMono8).data);
  EXPECT_EQ(undo.border(), HiddenBorder{});
}

TEST(DriftUndo, TakesWhatMovedBackAndMirrorsTheBorder) {
  const Plane<std::uint8_t> image = counted();
  const ImageView view = image_view(image.view(), PixelFormat::kMono8);
  std::vector<ZSlice> batch{{view, 20.0}, {view, -10.0}};
  DriftUndo undo(DriftPath(0.1, -0.05, 0.0));  // 2 px right, 1 px up at 20 um

  undo.apply(batch);

  const auto moved = batch[0].image.as<std::uint8_t>();
  EXPECT_EQ(moved.at(0, 1), image.at(2, 0));
  EXPECT_EQ(moved.at(2, 3), image.at(4, 2));
  EXPECT_EQ(moved.at(3, 3), image.at(4, 2));
  EXPECT_EQ(moved.at(4, 3), image.at(3, 2));
  EXPECT_EQ(moved.at(0, 0), image.at(2, 0));
  const auto back = batch[1].image.as<std::uint8_t>();
  EXPECT_EQ(back.at(1, 0), image.at(0, 1));
  EXPECT_EQ(undo.border(), (HiddenBorder{1, 2, 1, 1}));
}

TEST(DriftUndo, MovesColoursAndWidePixelsToo) {
  Plane<std::uint16_t> image(3, 1, 0);
  image.at(2, 0) = 4000;
  const std::vector<std::uint8_t> colour{1, 2, 3, 4, 5, 6, 7, 8, 9};
  std::vector<ZSlice> batch{{image_view(image.view(), PixelFormat::kMono12), 10.0, colour.data()}};
  DriftUndo undo(DriftPath(0.1, 0.0, 0.0));

  undo.apply(batch);

  EXPECT_EQ(batch[0].image.as<std::uint16_t>().at(1, 0), 4000);
  EXPECT_EQ(std::vector<std::uint8_t>(batch[0].colour, batch[0].colour + 6),
            (std::vector<std::uint8_t>{4, 5, 6, 7, 8, 9}));
}

TEST(DriftUndo, SurvivesADriftBeyondTheImage) {
  const Plane<std::uint8_t> image = counted();
  std::vector<ZSlice> batch{{image_view(image.view(), PixelFormat::kMono8), 1000.0}};
  DriftUndo undo(DriftPath(10.0, -10.0, 0.0));

  undo.apply(batch);

  EXPECT_EQ(undo.border(), (HiddenBorder{0, 4, 3, 0}));
}

TEST(HideBorder, MakesHolesOfWhatNotEverySliceShows) {
  HeightMap map = empty_map(20, 10, PixelFormat::kMono8);
  for (auto& height : map.height_m.pixels()) height = 1.0F;
  for (auto& sigma : map.sigma_m.pixels()) sigma = 1.0F;
  for (auto& reasons : map.mask.pixels()) reasons = 0;

  hide_border(map, {0, 3, 1, 0}, 2);

  for (int y = 0; y < 10; ++y) {
    for (int x = 0; x < 20; ++x) {
      const bool hidden = x >= 15 || y < 3;
      EXPECT_EQ(map.mask.at(x, y), hidden ? mask_reason::kOutOfView : 0) << x << ' ' << y;
      EXPECT_EQ(std::isnan(map.height_m.at(x, y)), hidden);
      EXPECT_EQ(std::isnan(map.sigma_m.at(x, y)), hidden);
    }
  }
}

}  // namespace
}  // namespace fvd
