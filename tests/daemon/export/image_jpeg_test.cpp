#include "daemon/export/image_jpeg.hpp"

#include <gtest/gtest.h>

#include "drivers/replay/image_file.hpp"
#include "tests/support/expect_error.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd {
namespace {

ImageFile read_back(const std::string& jpeg) {
  const test::ScratchDir scratch;
  test::write_text(scratch / "a.jpg", jpeg);
  ImageFile image;
  read_jpeg(scratch / "a.jpg", image);
  return image;
}

TEST(ImageJpeg, IsThePictureNearlyAsItWas) {
  Plane<std::uint8_t> picture(61, 47);
  for (int y = 0; y < 47; ++y) {
    for (int x = 0; x < 61; ++x) picture.at(x, y) = static_cast<std::uint8_t>(2 * x + 2 * y);
  }

  ImageFile image = read_back(encode_grey_jpeg(picture.view(), 80));

  ASSERT_EQ(image.width, 61);
  ASSERT_EQ(image.height, 47);
  ASSERT_EQ(image.channels, 1);
  for (int y = 0; y < 47; ++y) {
    for (int x = 0; x < 61; ++x) EXPECT_NEAR(std::to_integer<int>(image.row(y)[x]), 2 * x + 2 * y, 12);
  }
}

TEST(ImageJpeg, ReadsRowsWhereTheyLie) {
  Plane<std::uint8_t> padded(64, 16, 250);
  for (int y = 0; y < 16; ++y) {
    for (int x = 0; x < 16; ++x) padded.at(x, y) = 50;
  }

  ImageFile image = read_back(encode_grey_jpeg({padded.row(0), 16, 16, 64}, 90));

  ASSERT_EQ(image.width, 16);
  for (int y = 0; y < 16; ++y) {
    for (int x = 0; x < 16; ++x) EXPECT_NEAR(std::to_integer<int>(image.row(y)[x]), 50, 3);
  }
}

TEST(ImageJpeg, RefusesWhatIsNoPicture) {
  const Plane<std::uint8_t> picture(4, 4, 0);
  FVD_EXPECT_ERROR(kInternal, (void)encode_grey_jpeg({picture.row(0), 0, 4, 4}, 80));
  FVD_EXPECT_ERROR(kInternal, (void)encode_grey_jpeg({picture.row(0), 4, 4, 4}, 101));
}

}  // namespace
}  // namespace fvd
