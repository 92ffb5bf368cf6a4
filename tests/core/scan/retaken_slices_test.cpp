// Scans whose camera sends frames that must not be believed.

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/scan/focus_worker.hpp"
#include "core/scan/scan_runner.hpp"
#include "sim/fakes/fakes.hpp"
#include "sim/world/defocus_renderer.hpp"
#include "sim/world/texture.hpp"
#include "tests/support/expect_error.hpp"

namespace fvd {
namespace {

using testing::IsEmpty;
using testing::SizeIs;

constexpr int kSide_px = 240;
constexpr int kSlices = 21;

/// Two plateaus, 50 um apart; the left one at 75 um.
class AScanOfAStep : public testing::Test {
 protected:
  AScanOfAStep() : renderer_(texture(), plateaus(), {}) {
    plan_.step = Micrometers{10.0};
    plan_.slices = kSlices;
  }

  static Plane<float> texture() {
    return sim::make_texture(sim::TextureKind::kGranite, Plane<std::uint8_t>(kSide_px, kSide_px), 25.0, 1.0, 1);
  }
  static Plane<float> plateaus() {
    Plane<float> height_um(kSide_px, kSide_px, 75.0F);
    for (int y = 0; y < kSide_px; ++y) std::fill_n(height_um.row(y) + kSide_px / 2, kSide_px / 2, 125.0F);
    return height_um;
  }

  /// Heights of both plateaus from a scan in which the frames of these triggers, from 1 on, are dark.
  void scan(const std::vector<int>& dark_triggers) {
    sim::FakeClock clock;
    sim::FakeAxis stage(clock);
    sim::FakeCamera camera(clock, kSide_px, kSide_px);
    std::vector<std::byte> last;
    camera.paint = [&](int trigger, std::span<std::byte> pixels) {
      sim::ExposureRequest request;
      request.width = request.height = kSide_px;
      request.exposure_index = static_cast<std::uint64_t>(trigger);
      renderer_.render(stage.targets_um.back(), request, pixels);
      if (std::find(dark_triggers.begin(), dark_triggers.end(), trigger) == dark_triggers.end()) return;
      for (std::byte& pixel : pixels) pixel = static_cast<std::byte>(8 + static_cast<int>(pixel) % 3);
    };
    WorkerPool pool(1);
    StreamingFocusStack stack(kSide_px, kSide_px, PixelFormat::kMono8, {}, pool);
    FocusWorker worker(stack, 2 * kSlices, plan_.allowed_lost_slices);  // a fake clock cannot wait for room
    report_ = {};
    ScanRunner({camera, stage, clock, worker}).run(plan_, report_, {}, {});
    worker.finish();
    suspects_left_out_ = worker.suspects();
    slices_ = stack.slices();
    const HeightMap map = stack.finish(PeakMethod::kFiveSample);
    step_um_ = median_um(map, kSide_px * 5 / 8) - median_um(map, kSide_px / 8);
  }

  static double median_um(const HeightMap& map, int left) {
    std::vector<float> heights;
    for (int y = 12; y < kSide_px - 12; ++y) {
      for (int x = left; x < left + kSide_px / 4; ++x) {
        if (!std::isnan(map.height_m.at(x, y))) heights.push_back(map.height_m.at(x, y));
      }
    }
    if (heights.empty()) return std::numeric_limits<double>::quiet_NaN();
    std::nth_element(heights.begin(), heights.begin() + static_cast<std::ptrdiff_t>(heights.size() / 2), heights.end());
    return 1e6 * static_cast<double>(heights[heights.size() / 2]);
  }

  sim::DefocusRenderer renderer_;
  ScanPlan plan_;
  ScanReport report_;
  std::vector<SuspectSlice> suspects_left_out_;
  int slices_ = 0;
  double step_um_ = 0.0;
};

TEST_F(AScanOfAStep, TakesADarkFrameAgainWhereverItComes) {
  for (const int trigger : {1, 3, 11}) {
    SCOPED_TRACE(trigger);
    scan({trigger});
    EXPECT_NEAR(step_um_, 50.0, 0.05);
    ASSERT_THAT(report_.suspects, SizeIs(1));
    EXPECT_EQ(report_.suspects[0].index, trigger - 1);
    EXPECT_EQ(report_.suspects[0].reason, SuspectReason::kDark);
    EXPECT_EQ(report_.suspects[0].done, SuspectDone::kTakenAgain);
    EXPECT_EQ(report_.steps[static_cast<std::size_t>(trigger - 1)].triggers, 2);
    EXPECT_EQ(slices_, kSlices);
    EXPECT_THAT(suspects_left_out_, IsEmpty());
    EXPECT_TRUE(report_.frames.balanced());
  }
}

TEST_F(AScanOfAStep, TakesNothingAgainThatIsGood) {
  scan({});
  EXPECT_NEAR(step_um_, 50.0, 0.05);
  EXPECT_THAT(report_.suspects, IsEmpty());
  EXPECT_EQ(slices_, kSlices);
}

TEST_F(AScanOfAStep, LeavesASliceOutThatStaysDarkOrFails) {
  plan_.frame_retries = 1;
  plan_.allowed_lost_slices = 1;
  scan({11, 12});
  EXPECT_NEAR(step_um_, 50.0, 0.1);
  ASSERT_THAT(report_.suspects, SizeIs(2));
  EXPECT_EQ(report_.suspects[1].done, SuspectDone::kLeftOut);
  EXPECT_FALSE(report_.steps[10].measured);
  EXPECT_EQ(report_.lost_slices, 1);
  EXPECT_EQ(slices_, kSlices - 1);
  plan_.allowed_lost_slices = 0;
  test::expect_error(ErrorCode::kBadSlice, {"slice 10 at 100 um is dark", "in 2 frames", "the recipe allows 0"}, [&] {
    scan({11, 12});
  });
}

}  // namespace
}  // namespace fvd
