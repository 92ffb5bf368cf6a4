#include "daemon/views/live_picture.hpp"

#include <gtest/gtest.h>

#include "daemon/export/preview_hub.hpp"
#include "drivers/replay/image_file.hpp"
#include "tests/daemon/views/fake_pictures.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd {
namespace {

TEST(LivePicture, IsNoneBeforeTheFirst) {
  FakePictures pictures;
  LivePicture live(pictures);

  EXPECT_EQ(live.other_than(0), nullptr);
  EXPECT_EQ(live.other_than(7), nullptr);
}

TEST(LivePicture, IsThePictureAsAJpegWithItsFacts) {
  FakePictures pictures;
  pictures.show(3);
  LivePicture live(pictures);

  const auto shown = live.other_than(0);

  ASSERT_TRUE(shown);
  EXPECT_EQ(shown->seq, 3U);
  EXPECT_EQ(shown->image_width_px, 640);
  EXPECT_EQ(shown->image_height_px, 320);
  EXPECT_EQ(shown->z_um, 12.5);
  EXPECT_EQ(shown->focus, 8.25);
  EXPECT_EQ(shown->saturated_fraction, 0.125);
  const test::ScratchDir scratch;
  test::write_text(scratch / "live.jpg", shown->jpeg);
  ImageFile image;
  read_jpeg(scratch / "live.jpg", image);
  EXPECT_EQ(image.width, 64);
  EXPECT_EQ(image.height, 32);
  EXPECT_EQ(image.channels, 1);
  const auto level = [&image](int x, int y) { return std::to_integer<int>(image.row(y)[x]); };
  EXPECT_GT(level(5, 5), 150) << "bright at the upper left alone";
  EXPECT_LT(level(60, 5), 100);
  EXPECT_LT(level(5, 28), 100);
}

TEST(LivePicture, IsEncodedOnceForAll) {
  FakePictures pictures;
  pictures.show(3);
  LivePicture live(pictures);

  const auto first = live.other_than(0);

  EXPECT_EQ(live.other_than(2), first) << "the same bytes, not equal ones";
  EXPECT_EQ(live.other_than(3), nullptr);
  pictures.show(4);
  EXPECT_EQ(live.other_than(3)->seq, 4U);
  EXPECT_EQ(live.other_than(4), nullptr);
  EXPECT_EQ(live.other_than(9000)->seq, 4U) << "of a daemon that was started anew";
}

}  // namespace
}  // namespace fvd
