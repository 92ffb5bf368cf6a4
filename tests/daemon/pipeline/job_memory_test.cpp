#include "daemon/pipeline/job_memory.hpp"

#include <gtest/gtest.h>

#include "core/base/large_array.hpp"
#include "core/focus/streaming_focus_stack.hpp"
#include "tests/support/expect_error.hpp"

namespace fvd {
namespace {

constexpr int kWidth = 2448;
constexpr int kHeight = 2048;
constexpr std::size_t kPixels = std::size_t{kWidth} * kHeight;

TEST(JobMemory, CountsStateMapsFramesAndFiles) {
  Recipe recipe;
  recipe.bin_slices = 1;
  recipe.camera.pool_frames = 4;
  const JobMemory plain = job_memory(recipe, kWidth, kHeight, 2);
  EXPECT_GE(plain.state_bytes, 20 * kPixels);
  EXPECT_EQ(plain.frames_bytes, 4 * kPixels);
  EXPECT_EQ(plain.encoding_bytes, 12 * kPixels);
  EXPECT_EQ(plain.state_bytes + plain.maps_bytes,
            StreamingFocusStack::memory_bytes(kWidth, kHeight, PixelFormat::kMono8, focus_settings(recipe), 2));
}

TEST(JobMemory, HasRoomForBinsThatAreChosenLater) {
  Recipe recipe;
  const JobMemory unknown = job_memory(recipe, kWidth, kHeight, 2);
  recipe.bin_slices = 3;
  EXPECT_EQ(unknown.state_bytes, job_memory(recipe, kWidth, kHeight, 2).state_bytes);
}

TEST(JobMemory, ASecondMethodTakesAnotherMapAndNoOtherState) {
  Recipe recipe;
  const JobMemory one = job_memory(recipe, kWidth, kHeight, 2);
  recipe.extra_peaks = {PeakMethod::kParabola};
  const JobMemory two = job_memory(recipe, kWidth, kHeight, 2);
  EXPECT_EQ(two.maps_bytes, 2 * one.maps_bytes);
  EXPECT_EQ(two.state_bytes, one.state_bytes);
}

TEST(JobMemory, CountsWhatIsKeptOfSeveralScans) {
  Recipe recipe;
  const JobMemory one = job_memory(recipe, kWidth, kHeight, 2);
  recipe.repeat = 2;
  const JobMemory two = job_memory(recipe, kWidth, kHeight, 2);
  EXPECT_EQ(two.maps_bytes, one.maps_bytes + 26 * kPixels);
  EXPECT_EQ(two.state_bytes, one.state_bytes) << "one scan's at a time";
  recipe.repeat = 20;
  EXPECT_EQ(job_memory(recipe, kWidth, kHeight, 2).total_bytes(), two.total_bytes());
}

TEST(JobMemory, CountsTheSecondPeak) {
  Recipe recipe;
  const JobMemory without = job_memory(recipe, kWidth, kHeight, 2);
  recipe.focus.tests.second_peak = 0.8;
  EXPECT_EQ(job_memory(recipe, kWidth, kHeight, 2).state_bytes, without.state_bytes + 2 * kPixels);
}

TEST(JobMemory, RefusesWhatOnlyItsFilesTakeOverTheBudget) {
  const JobMemory needed = job_memory({}, kWidth, kHeight, 2);
  require_memory(needed, kWidth, kHeight, needed.total_bytes(), nullptr);
  test::expect_error(ErrorCode::kMemoryBudget, {"2448 x 2048", "files", "compute.memory_budget_mib"}, [&] {
    require_memory(needed, kWidth, kHeight, needed.total_bytes() - needed.encoding_bytes / 2, nullptr);
  });
}

TEST(JobMemory, CountsThePagesThatAreKept) {
  const JobMemory needed = job_memory({}, kWidth, kHeight, 2);
  constexpr std::size_t kBytes = std::size_t{8} << 20;
  const auto pages = std::make_shared<KeptPages>(2 * kBytes);
  { const LargeArray<std::uint8_t> array(kBytes, pages); }
  ASSERT_EQ(pages->kept_bytes(), kBytes);
  require_memory(needed, kWidth, kHeight, needed.total_bytes() + kBytes, pages.get());
  EXPECT_EQ(pages->kept_bytes(), kBytes) << "the budget holds both";
  require_memory(needed, kWidth, kHeight, needed.total_bytes() + kBytes - 1, pages.get());
  EXPECT_EQ(pages->kept_bytes(), 0U);
}

}  // namespace
}  // namespace fvd
