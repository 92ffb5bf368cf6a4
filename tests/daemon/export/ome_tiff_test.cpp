#include "daemon/export/ome_tiff.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/mount.h>
#include <tiffio.h>

#include "tests/support/expect_error.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd {
namespace {

using test::ScratchDir;
using testing::HasSubstr;
using testing::Not;

OmeStack stack_of(int width, int height, std::vector<double> z_um) {
  OmeStack stack;
  stack.name = "part <1> & \"2\"\n";
  stack.software = "fvd 1.2.3";
  stack.format = PixelFormat::kMono16;
  stack.width = width;
  stack.height = height;
  stack.z_um = std::move(z_um);
  return stack;
}

/// Each slice's level is its number, its last pixel 7.
struct Slices {
  explicit Slices(const OmeStack& stack) : plane(stack.width, stack.height) {}
  ImageView operator()(int index) {
    asked.push_back(index);
    std::fill(plane.pixels().begin(), plane.pixels().end(), static_cast<std::uint16_t>(index));
    plane.pixels().back() = 7;
    return image_view(plane.view(), PixelFormat::kMono16);
  }
  Plane<std::uint16_t> plane;
  std::vector<int> asked;
};

std::uint16_t pixel(TIFF* tiff, int x, int y, int width) {
  std::vector<std::uint16_t> row(static_cast<std::size_t>(width));
  EXPECT_EQ(TIFFReadScanline(tiff, row.data(), static_cast<std::uint32_t>(y), 0), 1);
  return row[static_cast<std::size_t>(x)];
}

TEST(OmeTiff, HoldsEachSliceOnceInOrder) {
  const ScratchDir scratch;
  const OmeStack stack = stack_of(700, 900, {1.0, 2.0, 3.0});  // two strips
  Slices slices(stack);

  write_ome_tiff(scratch / "a.tif", stack, std::ref(slices));

  EXPECT_THAT(slices.asked, testing::ElementsAre(0, 1, 2));
  TIFF* const tiff = TIFFOpen((scratch / "a.tif").c_str(), "r");
  ASSERT_NE(tiff, nullptr);
  EXPECT_FALSE(TIFFIsBigTIFF(tiff));
  EXPECT_EQ(TIFFNumberOfDirectories(tiff), 3U);
  for (int i = 0; i < 3; ++i) {
    ASSERT_EQ(TIFFSetDirectory(tiff, static_cast<tdir_t>(i)), 1);
    EXPECT_EQ(pixel(tiff, 0, 0, 700), i);
    EXPECT_EQ(pixel(tiff, 699, 898, 700), i);
    EXPECT_EQ(pixel(tiff, 699, 899, 700), 7);
  }
  TIFFClose(tiff);
}

TEST(OmeTiff, IsBigWhereTheClassicFormatHasNoRoom) {
  const ScratchDir scratch;
  const OmeStack stack = stack_of(100, 100, {1.0, 2.0, 3.0});
  Slices slices(stack);

  write_ome_tiff(scratch / "big.tif", stack, std::ref(slices), 60'000);
  write_ome_tiff(scratch / "classic.tif", stack, std::ref(slices), 70'000);

  for (const auto& [name, is_big] : {std::pair{"big.tif", true}, std::pair{"classic.tif", false}}) {
    TIFF* const tiff = TIFFOpen((scratch / name).c_str(), "r");
    ASSERT_NE(tiff, nullptr);
    EXPECT_EQ(TIFFIsBigTIFF(tiff) != 0, is_big) << name;
    EXPECT_EQ(TIFFNumberOfDirectories(tiff), 3U);
    ASSERT_EQ(TIFFSetDirectory(tiff, 2), 1);
    EXPECT_EQ(pixel(tiff, 5, 0, 100), 2);
    TIFFClose(tiff);
  }
  EXPECT_LT(kClassicTiff_bytes, std::uint64_t{1} << 32U);
}

TEST(OmeTiff, SaysThatTheDiskIsFullAndLeavesNothing) {
  const ScratchDir scratch;
  if (::mount("tmpfs", scratch.path().c_str(), "tmpfs", 0, "size=64k") != 0) {
    GTEST_SKIP() << "no right to mount a small tmpfs here";
  }
  const OmeStack stack = stack_of(200, 200, {1.0, 2.0});
  Slices slices(stack);

  test::expect_error(ErrorCode::kStorageFull, {"No space left", "a.tif"},
                     [&] { write_ome_tiff(scratch / "a.tif", stack, std::ref(slices)); });

  EXPECT_THAT(scratch.entries(), testing::IsEmpty());
  ::umount(scratch.path().c_str());
}

TEST(OmeTiff, LeavesNothingWhereASliceCannotBeGiven) {
  const ScratchDir scratch;
  const OmeStack stack = stack_of(20, 20, {1.0, 2.0});
  Slices slices(stack);
  const auto source = [&slices](int index) {
    if (index == 1) throw Error(ErrorCode::kBadInput, "slice 1 is damaged");
    return slices(index);
  };

  test::expect_error(ErrorCode::kBadInput, {"slice 1"}, [&] { write_ome_tiff(scratch / "a.tif", stack, source); });

  EXPECT_THAT(scratch.entries(), testing::IsEmpty());
}

TEST(OmeXml, EscapesNamesAndLeavesOutWhatIsNotKnown) {
  OmeStack stack = stack_of(20, 10, {0.1 + 0.2, -1.5});

  const std::string bare = ome_xml(stack);
  EXPECT_THAT(bare, HasSubstr("Name=\"part &lt;1&gt; &amp; &quot;2&quot; \""));
  EXPECT_THAT(bare, HasSubstr("PositionZ=\"0.30000000000000004\""));
  EXPECT_THAT(bare, HasSubstr("PositionZ=\"-1.5\" PositionZUnit=\"µm\""));
  EXPECT_THAT(bare, Not(HasSubstr("PhysicalSize")));
  EXPECT_THAT(bare, Not(HasSubstr("ExposureTime")));
  EXPECT_THAT(bare, Not(HasSubstr("<Description")));

  stack.step_um = -1.8;
  stack.pitch_x_um = 0.5;
  EXPECT_THAT(ome_xml(stack), HasSubstr("PhysicalSizeZ=\"1.8\"")) << "no sign in the schema";
  EXPECT_THAT(ome_xml(stack), Not(HasSubstr("PhysicalSizeX"))) << "one of two is none";
}

}  // namespace
}  // namespace fvd
