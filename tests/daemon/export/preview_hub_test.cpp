#include "daemon/export/preview_hub.hpp"

#include <chrono>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace fvd {
namespace {

Plane<std::uint8_t> grey_image(int width, int height) { return Plane<std::uint8_t>(width, height, 100); }
ImageView seen(const Plane<std::uint8_t>& image) { return image_view(image.view(), PixelFormat::kMono8); }

TEST(PreviewPicture, IsAtMost1280PixelsASide) {
  const Plane<std::uint8_t> large = grey_image(2448, 2048);
  const Plane<std::uint8_t> small = grey_image(480, 360);

  const PreviewPicture halved = make_preview(seen(large), 3.5);
  const PreviewPicture whole = make_preview(seen(small), 3.5);

  EXPECT_EQ(halved.pixels.width(), 1224);
  EXPECT_EQ(halved.pixels.height(), 1024);
  EXPECT_EQ(halved.image_width_px, 2448);
  EXPECT_EQ(halved.image_height_px, 2048);
  EXPECT_EQ(halved.z_um, 3.5);
  EXPECT_EQ(whole.pixels.width(), 480);
  EXPECT_EQ(whole.pixels.at(479, 359), 100);
}

TEST(PreviewPicture, TellsTheShareOfSaturatedPixels) {
  Plane<std::uint8_t> image = grey_image(100, 50);
  for (int x = 0; x < 100; ++x) image.at(x, 7) = 255;

  EXPECT_DOUBLE_EQ(make_preview(seen(image), 0.0).saturated_fraction, 0.02);
}

TEST(PreviewPicture, AsJsonIsAtMost640By480) {
  const Plane<std::uint8_t> large = grey_image(2448, 2048);
  PreviewPicture picture = make_preview(seen(large), 3.5);
  picture.seq = 8;

  const auto json = nlohmann::json::parse(preview_json(picture));

  EXPECT_EQ(json["seq"], 8);
  EXPECT_EQ(json["width_px"], 408);
  EXPECT_EQ(json["height_px"], 341);
  EXPECT_EQ(json["z_um"], 3.5);
  EXPECT_FALSE(json["png_base64"].get<std::string>().empty());
}

using std::chrono::milliseconds;

/// How many of these are taken.
int pictures_of(int offers, milliseconds (*at)(int)) {
  PicturePace pace;
  int taken = 0;
  for (int i = 0; i < offers; ++i) {
    const HostTime now = HostTime{} + std::chrono::hours(1) + at(i);
    if (!pace.is_due(now)) continue;
    pace.taken(now);
    ++taken;
  }
  return taken;
}

TEST(PicturePace, TakesAllOfACameraThatGivesTenASecond) {
  EXPECT_EQ(pictures_of(1000, [](int i) { return milliseconds(100 * i); }), 1000);
  EXPECT_GE(pictures_of(1000, [](int i) { return milliseconds(100 * i + (i * 7919) % 41 - 20); }), 999);
  EXPECT_EQ(pictures_of(100, [](int i) { return milliseconds(150 * i); }), 100);
}

TEST(PicturePace, TakesTenASecondOfAFasterOne) {
  EXPECT_LE(pictures_of(3000, [](int i) { return milliseconds(10 * i); }), 301);
  EXPECT_GE(pictures_of(3000, [](int i) { return milliseconds(10 * i); }), 300);
  // 7 ms apart, a pause of ten minutes before each hundred: nothing piles up meanwhile.
  EXPECT_LE(pictures_of(200, [](int i) { return milliseconds(7 * i + 600'000 * (i / 100)); }), 2 * 8);
}

TEST(PreviewHub, KeepsNoSliceWithoutAViewer) {
  const Plane<std::uint8_t> image = grey_image(64, 48);
  PreviewHub hub;

  hub.offer(seen(image), 1.0);
  EXPECT_EQ(hub.newest_picture(), nullptr);  // who asked is a viewer from now on
  hub.offer(seen(image), 2.0);

  const auto picture = hub.newest_picture();
  ASSERT_TRUE(picture);
  EXPECT_EQ(picture->seq, 1U);
  EXPECT_EQ(picture->z_um, 2.0);
  EXPECT_EQ(nlohmann::json::parse(hub.newest().value())["z_um"], 2.0);
}

TEST(PreviewHub, KeepsTheImageThatSomebodyTook) {
  const Plane<std::uint8_t> image = grey_image(64, 48);
  PreviewHub hub;

  const auto first = hub.take(seen(image), 1.0);
  const auto second = hub.take(seen(image), 2.0);

  EXPECT_EQ(first->seq, 1U);
  EXPECT_EQ(second->seq, 2U);
  EXPECT_EQ(hub.newest_picture(), second);
  EXPECT_EQ(first->z_um, 1.0) << "who has a picture has it still";
}

TEST(PreviewHub, GoesOnCountingAfterAScan) {
  const Plane<std::uint8_t> image = grey_image(64, 48);
  PreviewHub hub;
  hub.take(seen(image), 1.0);

  hub.clear();
  EXPECT_EQ(hub.newest_picture(), nullptr);
  EXPECT_FALSE(hub.newest());
  hub.offer(seen(image), 2.0);

  EXPECT_EQ(hub.newest_picture()->seq, 2U);
}

}  // namespace
}  // namespace fvd
