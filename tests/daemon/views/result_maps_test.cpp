#include "daemon/views/result_maps.hpp"

#include <cmath>

#include <gmock/gmock.h>

#include "tests/daemon/views/made_maps.hpp"
#include "tests/support/expect_error.hpp"

namespace fvd {
namespace {

namespace fs = std::filesystem;
using test::ScratchDir;

std::vector<float> points_of(const OpenedMap& map) {
  const GridSize size = map.rows->size();
  std::vector<float> points(static_cast<std::size_t>(size.points()));
  for (int y = 0; y < size.height; ++y) map.rows->read(0, y, size.width, points.data() + y * size.width);
  return points;
}

TEST(ResultMaps, HaveWhatTheResultsFilesHave) {
  const ScratchDir scratch;
  const ResultData data = test::result_with(test::rough(7, 5, 0.2));
  write_result(scratch / "J7", data);
  ResultMaps maps(scratch / "J7");

  const auto heights = maps.find(MapKind::kHeight);
  const auto sigmas = maps.find(MapKind::kSigma);
  const auto texture = maps.find(MapKind::kTexture);
  const auto reasons = maps.find(MapKind::kReason);

  ASSERT_TRUE(heights && sigmas && texture && reasons);
  EXPECT_EQ(heights->rows->size().width, 7);
  EXPECT_EQ(heights->rows->size().height, 5);
  std::size_t i = 0;
  for (int y = 0; y < 5; ++y) {
    for (int x = 0; x < 7; ++x, ++i) {
      const bool hole = std::isnan(data.map.height_m.at(x, y));
      EXPECT_TRUE(hole ? std::isnan(points_of(*heights)[i]) : points_of(*heights)[i] == data.map.height_m.at(x, y));
      EXPECT_TRUE(hole ? std::isnan(points_of(*sigmas)[i]) : points_of(*sigmas)[i] == data.map.sigma_m.at(x, y));
      EXPECT_EQ(points_of(*texture)[i], static_cast<float>(data.map.texture.at(x, y)));
      EXPECT_EQ(points_of(*reasons)[i], static_cast<float>(data.map.mask.at(x, y)));
    }
  }
}

TEST(ResultMaps, HoldNothingOfATiffInMemory) {
  const ScratchDir scratch;
  write_result(scratch / "J7", test::result_with(test::rough(40, 30, 0.0)));
  ResultMaps maps(scratch / "J7");

  (void)maps.find(MapKind::kHeight);
  (void)maps.find(MapKind::kSigma);
  EXPECT_EQ(maps.bytes(), 0U);
  (void)maps.find(MapKind::kReason);
  EXPECT_EQ(maps.bytes(), 40U * 30U * 2U);
  (void)maps.find(MapKind::kReason);
  EXPECT_EQ(maps.bytes(), 40U * 30U * 2U) << "opened once";
}

TEST(ResultMaps, LackWhatTheRecipeLeftOut) {
  const ScratchDir scratch;
  ResultData data = test::result_with(test::rough(7, 5, 0.2));
  data.exports = {"x3p"};
  write_result(scratch / "J7", data);
  ResultMaps maps(scratch / "J7");

  const auto heights = maps.find(MapKind::kHeight);

  ASSERT_TRUE(heights);
  EXPECT_EQ(points_of(*heights).front(), data.map.height_m.at(0, 0));
  EXPECT_EQ(heights->rows->bytes(), 7U * 5U * 4U) << "a zip has no places of points";
  EXPECT_FALSE(maps.find(MapKind::kSigma));
  EXPECT_FALSE(maps.find(MapKind::kTexture));
  EXPECT_FALSE(maps.find(MapKind::kReason));
}

TEST(ResultMaps, TakeNoLinkForAFile) {
  const ScratchDir scratch;
  write_result(scratch / "J7", test::result_with(test::rough(7, 5, 0.2)));
  for (const char* name : {"height.tiff", "mask.png"}) {
    fs::rename(scratch / "J7" / name, scratch / name);
    fs::create_symlink(scratch / name, scratch / "J7" / name);
  }
  ResultMaps maps(scratch / "J7");

  EXPECT_FALSE(maps.find(MapKind::kHeight));
  EXPECT_FALSE(maps.find(MapKind::kReason));
  EXPECT_FALSE(ResultMaps(scratch / "none").find(MapKind::kHeight));
}

TEST(ResultMaps, RefuseFilesThatDoNotFit) {
  const ScratchDir scratch;
  write_result(scratch / "J7", test::result_with(test::rough(7, 5, 0.2)));
  write_result(scratch / "J8", test::result_with(test::rough(5, 7, 0.2)));
  for (const char* name : {"sigma.tiff", "mask.png"}) {
    fs::copy_file(scratch / "J8" / name, scratch / "J7" / name, fs::copy_options::overwrite_existing);
  }
  test::write_text(scratch / "J7" / "texture.png", "no picture at all, but long enough to have a size");
  ResultMaps maps(scratch / "J7");

  FVD_EXPECT_ERROR_SAYING(kSurfaceFile, (void)maps.find(MapKind::kSigma), testing::HasSubstr("5 x 7"));
  FVD_EXPECT_ERROR_SAYING(kSurfaceFile, (void)maps.find(MapKind::kReason), testing::HasSubstr("5 x 7"));
  FVD_EXPECT_ERROR_SAYING(kSurfaceFile, (void)maps.find(MapKind::kTexture), testing::HasSubstr("texture.png"));
  test::write_text(scratch / "J8" / "height.tiff", "II*");
  FVD_EXPECT_ERROR(kSurfaceFile, (void)ResultMaps(scratch / "J8").find(MapKind::kHeight));
}

TEST(ResultMaps, TellOneStateOfAFileFromAnother) {
  const ScratchDir scratch;
  write_result(scratch / "J7", test::result_with(test::rough(7, 5, 0.2)));
  const auto tag = [&] { return ResultMaps(scratch / "J7").find(MapKind::kHeight)->tag; };
  const std::string before = tag();

  EXPECT_EQ(tag(), before);
  fs::copy_file(scratch / "J7" / "height.tiff", scratch / "copy");
  fs::rename(scratch / "copy", scratch / "J7" / "height.tiff");
  EXPECT_NE(tag(), before);
  EXPECT_THAT(before, testing::MatchesRegex("[0-9a-f]+-[0-9a-f]+-[0-9a-f]+"));
}

TEST(MapKindNames, ReadBack) {
  for (const MapKind kind : kAllMapKinds) EXPECT_EQ(map_kind_from_name(map_kind_name(kind)), kind);
  EXPECT_FALSE(map_kind_from_name("heights"));
  EXPECT_FALSE(map_kind_from_name(""));
}

}  // namespace
}  // namespace fvd
