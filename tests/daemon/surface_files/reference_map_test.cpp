#include "daemon/surface_files/reference_map.hpp"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "daemon/export/gsf.hpp"
#include "tests/support/expect_error.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd {
namespace {

using test::ScratchDir;
using test::write_text;
using ::testing::HasSubstr;

/// height[y][x] = x + 10 y um, with a hole at (1, 0).
std::string map_of(int width, int height, float scale = 1e-6F) {
  Plane<float> metres(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) metres.at(x, y) = scale * static_cast<float>(x + 10 * y);
  }
  metres.at(1, 0) = std::numeric_limits<float>::quiet_NaN();
  return encode_gsf(metres, {"reference", 0.48, 0.52, {}});
}

TEST(AReferenceMap, IsReadWithItsStandardErrors) {
  const ScratchDir folder;
  write_text(folder / "cal-0003-flatness.gsf", map_of(4, 3));
  write_text(folder / "cal-0003-flatness-sigma.gsf", map_of(4, 3, 1e-9F));

  const auto map = read_reference_map(folder.path(), "cal-0003-flatness.gsf");

  EXPECT_NEAR(map->z_um.at(3, 2), 23.0, 1e-5);
  EXPECT_NEAR(map->sigma_um.at(3, 2), 0.023F, 1e-8F);
  EXPECT_TRUE(map->is_hole(1, 0));
  EXPECT_TRUE(std::isnan(map->sigma_um.at(1, 0)));
  EXPECT_EQ(map->pitch_x_um, 0.48);
  EXPECT_EQ(map->pitch_y_um, 0.52);
}

TEST(AReferenceMap, MayHaveNoStandardErrors) {
  const ScratchDir folder;
  write_text(folder / "flat.gsf", map_of(4, 3));

  EXPECT_FALSE(read_reference_map(folder.path(), "flat.gsf")->has_sigma());
}

TEST(AReferenceMap, HasHolesWhereTheErrorIsNotKnown) {
  const ScratchDir folder;
  write_text(folder / "flat.gsf", map_of(4, 3));
  write_text(folder / "flat-sigma.gsf", map_of(4, 3, -1e-9F));

  const auto map = read_reference_map(folder.path(), "flat.gsf");

  EXPECT_FALSE(map->is_hole(0, 0));  // an error of 0
  EXPECT_TRUE(map->is_hole(2, 0));
}

TEST(AReferenceMap, IsRefusedWhereItIsNotWhole) {
  const ScratchDir folder;
  const std::string whole = map_of(4, 3);
  write_text(folder / "short.gsf", whole.substr(0, whole.size() - 1));
  write_text(folder / "flat.gsf", whole);
  write_text(folder / "flat-sigma.gsf", map_of(3, 4));

  FVD_EXPECT_ERROR_SAYING(kSurfaceFile, (void)read_reference_map(folder.path(), "gone.gsf"), HasSubstr("gone.gsf"));
  FVD_EXPECT_ERROR_SAYING(kSurfaceFile, (void)read_reference_map(folder.path(), "short.gsf"), HasSubstr("short.gsf"));
  FVD_EXPECT_ERROR_SAYING(kSurfaceFile, (void)read_reference_map(folder.path(), "flat.gsf"),
                          HasSubstr("flat-sigma.gsf"));
}

TEST(AReferenceMap, LiesInItsFolderAndNowhereElse) {
  const ScratchDir folder;
  write_text(folder / "flat.gsf", map_of(4, 3));
  std::filesystem::create_directory(folder / "inner");

  for (const std::string& name : {std::string("../flat.gsf"), (folder / "flat.gsf").string(), std::string()}) {
    FVD_EXPECT_ERROR_SAYING(kSurfaceFile, (void)read_reference_map(folder / "inner", name), HasSubstr("no name"));
  }
}

}  // namespace
}  // namespace fvd
