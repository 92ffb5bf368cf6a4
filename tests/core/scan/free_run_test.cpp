#include "core/scan/free_run.hpp"

#include <vector>

#include "core/base/error.hpp"
#include "gtest/gtest.h"
#include "sim/fakes/fakes.hpp"

namespace fvd {
namespace {

class ConfiguredCamera final : public sim::FakeCamera {
 public:
  explicit ConfiguredCamera(sim::FakeClock& clock) : FakeCamera(clock, 16, 12) {}
  CameraSettings configure(const CameraSettings& settings) override {
    triggers.push_back(settings.trigger);
    rate_hz = settings.frame_rate_hz;
    if (refuses) throw Error(ErrorCode::kCameraSettings, "locked");
    return settings;
  }
  std::vector<TriggerMode> triggers;
  double rate_hz = 0.0;
  bool refuses = false;
};

TEST(FreeRun, LeavesACameraAloneThatNeverRanFree) {
  sim::FakeClock clock;
  ConfiguredCamera camera(clock);
  { const FreeRun run(camera, {}); }
  EXPECT_TRUE(camera.triggers.empty());
}

TEST(FreeRun, QuietensTheCameraOnlyWhenItEnds) {
  sim::FakeClock clock;
  ConfiguredCamera camera(clock);
  {
    FreeRun run(camera, {});
    run.begin(40.0);
    EXPECT_EQ(camera.triggers, std::vector{TriggerMode::kFreeRun});
    EXPECT_EQ(camera.rate_hz, 40.0);
  }
  EXPECT_EQ(camera.triggers, (std::vector{TriggerMode::kFreeRun, TriggerMode::kSoftware}));
}

TEST(FreeRun, QuietensACameraThatRefusedToRunFree) {
  sim::FakeClock clock;
  ConfiguredCamera camera(clock);
  camera.refuses = true;
  {
    FreeRun run(camera, {});
    EXPECT_THROW(run.begin(40.0), Error);
  }
  EXPECT_EQ(camera.triggers.size(), 2U) << "it may have taken a part of it";
}

}  // namespace
}  // namespace fvd
