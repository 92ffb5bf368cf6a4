#include "core/image/shrink.hpp"

#include <gtest/gtest.h>

namespace fvd {
namespace {

TEST(Shrink, TakesTheMeanOfEachBlock) {
  Plane<std::uint8_t> image(7, 5, 0);
  for (int y = 0; y < 5; ++y) {
    for (int x = 0; x < 7; ++x) image.at(x, y) = static_cast<std::uint8_t>(10 * x + 40 * y);
  }

  const Plane<std::uint8_t> halved = shrink(image_view(image.view(), PixelFormat::kMono8), 2).pixels;
  const Plane<std::uint8_t> third = shrink(image_view(image.view(), PixelFormat::kMono8), 3).pixels;

  ASSERT_EQ(halved.width(), 3);
  ASSERT_EQ(halved.height(), 2);
  EXPECT_EQ(halved.at(0, 0), 25);
  EXPECT_EQ(halved.at(2, 1), 145);
  ASSERT_EQ(third.width(), 2);
  ASSERT_EQ(third.height(), 1);
  EXPECT_EQ(third.at(1, 0), 80);
}

TEST(Shrink, ByOneIsTheImageInEightBits) {
  Plane<std::uint16_t> image(3, 2, 0);
  image.at(0, 0) = 4095;
  image.at(1, 0) = 2048;
  image.at(2, 1) = 15;

  const ShrunkImage shrunk = shrink(image_view(image.view(), PixelFormat::kMono12), 1);

  EXPECT_EQ(shrunk.pixels.at(0, 0), 255);
  EXPECT_EQ(shrunk.pixels.at(1, 0), 128);
  EXPECT_EQ(shrunk.pixels.at(2, 1), 0);
  EXPECT_EQ(shrunk.saturated, 1);
}

TEST(Shrink, HoldsTheSumsOfBrightBlocks) {
  const Plane<std::uint16_t> wide(64, 64, 65535);
  const Plane<std::uint8_t> narrow(600, 600, 255);

  EXPECT_EQ(shrink(image_view(wide.view(), PixelFormat::kMono16), 64).pixels.at(0, 0), 255);
  EXPECT_EQ(shrink(image_view(narrow.view(), PixelFormat::kMono8), 257).pixels.at(1, 1), 255);
  EXPECT_EQ(shrink(image_view(narrow.view(), PixelFormat::kMono8), 300).pixels.at(1, 1), 255);
}

TEST(Shrink, CountsSaturatedPixelsOfTheWholeImage) {
  Plane<std::uint8_t> image(7, 5, 254);
  image.at(0, 0) = 255;
  image.at(6, 4) = 255;  // in no block

  EXPECT_EQ(shrink(image_view(image.view(), PixelFormat::kMono8), 2).saturated, 2);
}

TEST(Shrink, ReadsRowsWhereTheyLie) {
  Plane<std::uint8_t> padded(16, 4, 9);
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 6; ++x) padded.at(x, y) = 100;
  }
  const PlaneView<const std::uint8_t> view{padded.row(0), 6, 4, 16};

  const Plane<std::uint8_t> halved = shrink(image_view(view, PixelFormat::kMono8), 2).pixels;

  for (const std::uint8_t level : halved.pixels()) EXPECT_EQ(level, 100);
}

TEST(ShrinkFactor, IsTheLeastThatFits) {
  EXPECT_EQ(shrink_factor(2448, 2048, 1280, 1280), 2);
  EXPECT_EQ(shrink_factor(1280, 1280, 1280, 1280), 1);
  EXPECT_EQ(shrink_factor(1281, 10, 1280, 1280), 2);
  EXPECT_EQ(shrink_factor(10, 2561, 1280, 1280), 3);
  EXPECT_EQ(shrink_factor(480, 360, 640, 480), 1);
  EXPECT_EQ(shrink_factor(1, 5000, 1280, 1280), 1) << "a pixel remains";
}

}  // namespace
}  // namespace fvd
