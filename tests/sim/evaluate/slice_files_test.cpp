#include "sim/evaluate/slice_files.hpp"

#include <limits>

#include "drivers/replay/recorded_stack.hpp"
#include "drivers/replay/slice_heights.hpp"
#include "gtest/gtest.h"
#include "sim/world/gsf_reader.hpp"
#include "sim/world/surface.hpp"
#include "tests/support/expect_error.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd::sim {
namespace {

WorldParameters small_world() {
  WorldParameters world;
  world.surface = SurfaceKind::kTilted;
  world.width_px = 64;
  world.height_px = 48;
  world.base_um = 33.0;
  return world;
}

TEST(SliceFiles, AreARecordedStackWithItsTruthInEveryFormat) {
  for (const std::string& format : slice_formats()) {
    const test::ScratchDir scratch;
    const auto folder = scratch / "new/stack";
    const auto z_um =
        write_slices(small_world(), folder, {.start_um = -0.5, .step_um = 2.25, .slices = 11, .format = format});
    const RecordedStack stack(folder);
    ASSERT_EQ(stack.slices(), 11);
    EXPECT_EQ(stack.width(), 64);
    EXPECT_EQ(stack.height(), 48);
    EXPECT_EQ(stack.format(), PixelFormat::kMono8);
    EXPECT_EQ(stack.list().gap, "");
    EXPECT_NE(stack.read(0).pixels, stack.read(10).pixels);
    const auto written = slice_heights_um(ZFile{.path = folder / "z.txt"}, stack.list());
    ASSERT_EQ(written.size(), 11U);
    for (std::size_t k = 0; k < 11; ++k) {
      EXPECT_DOUBLE_EQ(z_um[k], -0.5 + 2.25 * static_cast<double>(k));
      EXPECT_NEAR(written[k], z_um[k], 1e-9);
    }
    const Plane<float> truth = read_gsf_um(folder / "truth/truth.gsf");
    EXPECT_NEAR(static_cast<double>(truth.at(5, 7)),
                static_cast<double>(make_surface(small_world()).height_um.at(5, 7)), 1e-4);
    EXPECT_TRUE(std::filesystem::exists(folder / "truth/regions.png"));
  }
}

TEST(SliceFiles, ReachBeyondTheSurfaceInBothDirectionsIfNothingIsSaid) {
  for (const double step : {10.0, -7.0}) {
    const test::ScratchDir scratch;
    const auto z_um = write_slices(small_world(), scratch / "stack", {.step_um = step});
    EXPECT_LT(std::min(z_um.front(), z_um.back()), 33.0 - 50.0);
    EXPECT_GT(std::max(z_um.front(), z_um.back()), 33.0 + 50.0);
    EXPECT_LT(z_um.size(), 20U);
  }
}

TEST(SliceFiles, RefuseWhatGivesNoStackAndWriteNothing) {
  const test::ScratchDir scratch;
  const auto refused = [&](const std::string& word, const SliceFileOptions& options) {
    test::expect_error(ErrorCode::kBadInput, {word},
                       [&] { (void)write_slices(small_world(), scratch / "stack", options); });
    EXPECT_FALSE(std::filesystem::exists(scratch / "stack")) << word;
  };
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  refused("step", {.step_um = 0.0});
  refused("step", {.step_um = kNan});
  refused("start", {.start_um = kNan});
  refused("start", {.start_um = 1e9});
  refused("ask for 1", {.slices = 1});
  refused("ask for -3", {.slices = -3});
  refused("ask for 10001", {.slices = 10001});
  refused("2 to 10000", {.step_um = 0.001});
  refused("2 to 10000", {.start_um = 500.0});
  refused("'jpg'", {.format = "jpg"});
}

TEST(SliceFiles, DoNotMixWithOthers) {
  const test::ScratchDir scratch;
  test::write_text(scratch / "slice_0099.png", "of another stack");
  test::expect_error(ErrorCode::kBadInput, {"not empty", scratch.path().string()},
                     [&] { (void)write_slices(small_world(), scratch.path(), {}); });
  EXPECT_EQ(scratch.entries().size(), 1U);
  test::expect_error(ErrorCode::kStorageWrite, {"slice_0099.png"},
                     [&] { (void)write_slices(small_world(), scratch / "slice_0099.png", {}); });
}

}  // namespace
}  // namespace fvd::sim
