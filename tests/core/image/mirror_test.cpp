#include "core/image/mirror.hpp"

#include <vector>

#include "gtest/gtest.h"

namespace fvd {
namespace {

/// A picture of width x height in rows of `stride`, whose pixels count on; the padding is 250.
template <typename Pixel>
struct Counted {
  Counted(int width, int height, int stride) : pixels(static_cast<std::size_t>(stride * height), Pixel{250}) {
    view = {pixels.data(), width, height, stride};
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) view.at(x, y) = static_cast<Pixel>(y * width + x);
    }
  }
  std::vector<Pixel> pixels;
  PlaneView<Pixel> view;
};

template <typename Pixel>
void expect_every_pixel_at_its_place(int width, int height, int stride, const Mirror& mirror) {
  Counted<Pixel> picture(width, height, stride);
  mirror_in_place(picture.view, mirror);
  for (int y = 0; y < height; ++y) {
    const int from_y = mirror.y ? height - 1 - y : y;
    for (int x = 0; x < width; ++x) {
      const int from_x = mirror.x ? width - 1 - x : x;
      ASSERT_EQ(picture.view.at(x, y), static_cast<Pixel>(from_y * width + from_x))
          << x << ' ' << y << " of " << width << " x " << height;
    }
    for (int x = width; x < stride; ++x) ASSERT_EQ(picture.view.row(y)[x], Pixel{250}) << "padding is left alone";
  }
  mirror_in_place(picture.view, mirror);
  EXPECT_EQ(picture.pixels, Counted<Pixel>(width, height, stride).pixels) << "twice is as before";
}

TEST(MirrorInPlace, PutsEveryPixelOfEverySizeInItsPlace) {
  for (const Mirror mirror : {Mirror{}, Mirror{true, false}, Mirror{false, true}, Mirror{true, true}}) {
    for (int width = 1; width <= 9; ++width) {
      for (int height = 1; height <= 9; ++height) {
        expect_every_pixel_at_its_place<std::uint8_t>(width, height, width, mirror);
        expect_every_pixel_at_its_place<std::uint16_t>(width, height, width + 3, mirror);
      }
    }
  }
}

}  // namespace
}  // namespace fvd
