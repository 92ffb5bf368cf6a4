#include "daemon/surface_files/result_folder.hpp"

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/focus/lateral_period.hpp"
#include "daemon/export/result_writer.hpp"
#include "tests/daemon/export/sample_result.hpp"
#include "tests/daemon/surface_files/sample_surface.hpp"
#include "tests/support/expect_error.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd {
namespace {

using test::ScratchDir;

ResultData odd_result() {
  ResultData data = test::sample_result();
  data.pixel_pitch_x_um = 0.1 + 0.2;  // 17 digits
  data.pixel_pitch_y_um = 1.0 / 3.0;
  return data;
}

TEST(ResultFolder, GivesTheSurfaceThatTheJobHad) {
  const ScratchDir scratch;
  const ResultData data = odd_result();
  write_result(scratch / "job", data);

  const ResultSurface read = read_result_surface(scratch / "job");

  test::expect_same_heights(read.surface.height_m, data.map.height_m);
  test::expect_same_heights(read.surface.sigma_m, data.map.sigma_m);
  EXPECT_THAT(read.surface.mask.pixels(), testing::ElementsAreArray(data.map.mask.pixels()));
  EXPECT_EQ(read.surface.pitch_x_um, 0.1 + 0.2);
  EXPECT_EQ(read.surface.pitch_y_um, 1.0 / 3.0);
  EXPECT_EQ(read.surface.lateral_period_um, lateral_period_px(data.focus, {}) * (1.0 / 3.0));
  EXPECT_EQ(read.surface.title, "part-42");
  EXPECT_EQ(read.result.recipe.id, "chapter");
}

TEST(ResultFolder, IsReadFromWhateverFileOfHeightsItHas) {
  for (const std::string format : {"tiff", "gsf", "sdf", "x3p"}) {
    SCOPED_TRACE(format);
    const ScratchDir scratch;
    ResultData data = odd_result();
    data.exports = {format};
    write_result(scratch / "job", data);

    const ResultSurface read = read_result_surface(scratch / "job");

    test::expect_same_heights(read.surface.height_m, data.map.height_m);
    EXPECT_EQ(read.surface.pitch_x_um, 0.1 + 0.2);
    EXPECT_EQ(read.surface.has_sigma(), format == "tiff" || format == "gsf");
    EXPECT_FALSE(read.surface.has_mask());
  }
}

TEST(ResultFolder, NeedsAPitchFromSomewhere) {
  const ScratchDir scratch;
  ResultData data = test::sample_result();
  data.pixel_pitch_x_um = data.pixel_pitch_y_um = std::nullopt;
  write_result(scratch / "job", data);

  FVD_EXPECT_ERROR_SAYING(kSurfaceFile, (void)read_result_surface(scratch / "job"),
                          testing::HasSubstr("must be given"));
  EXPECT_EQ(read_result_surface(scratch / "job", {2.0, 3.0}).surface.pitch_y_um, 3.0);
}

TEST(ResultFolder, IsRefusedWhereItsFilesDoNotFit) {
  const ScratchDir scratch;
  write_result(scratch / "job", test::sample_result());
  ResultData other = test::sample_result();
  other.map = test::sample_map(5, 3);
  write_result(scratch / "other", other);
  const auto copy = [&](const char* name) {
    std::filesystem::copy_file(scratch / "other" / name, scratch / "job" / name,
                               std::filesystem::copy_options::overwrite_existing);
  };

  copy("mask.png");
  FVD_EXPECT_ERROR_SAYING(kSurfaceFile, (void)read_result_surface(scratch / "job"),
                          testing::HasSubstr("mask.png: size"));
  test::write_text(scratch / "job" / "mask.png", "no picture");
  FVD_EXPECT_ERROR_SAYING(kSurfaceFile, (void)read_result_surface(scratch / "job"), testing::HasSubstr("mask.png"));
  std::filesystem::remove(scratch / "job" / "mask.png");
  copy("sigma.tiff");
  FVD_EXPECT_ERROR_SAYING(kSurfaceFile, (void)read_result_surface(scratch / "job"), testing::HasSubstr("sigma"));
  copy("height.tiff");
  FVD_EXPECT_ERROR_SAYING(kSurfaceFile, (void)read_result_surface(scratch / "job"), testing::HasSubstr("5 x 3"));
  test::write_text(scratch / "job" / "result.json", "{}");
  FVD_EXPECT_ERROR_SAYING(kSurfaceFile, (void)read_result_surface(scratch / "job"), testing::HasSubstr("result.json"));
}

}  // namespace
}  // namespace fvd
