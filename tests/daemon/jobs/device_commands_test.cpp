#include "daemon/jobs/device_commands.hpp"

#include <vector>

#include "gtest/gtest.h"
#include "sim/fakes/fakes.hpp"

namespace fvd {
namespace {

class SettingsCamera final : public sim::FakeCamera {
 public:
  using FakeCamera::FakeCamera;
  CameraSettings configure(const CameraSettings& settings) override {
    exposures_us.push_back(settings.exposure_us);
    return FakeCamera::configure(settings);
  }
  std::vector<double> exposures_us;
};

TEST(SuggestExposure, PutsTheExposureBackWhenTheCameraFails) {
  sim::FakeClock clock;
  using T = sim::TriggerOutcome;
  SettingsCamera camera(clock, 16, 16, {T::kFrame, T::kNothing, T::kNothing, T::kNothing, T::kNothing});
  sim::FakeAxis stage(clock);
  CameraSettings settings;
  settings.exposure_us = 2000.0;
  DeviceTask task(exposure_work(settings, 0.7));
  task.run({camera, stage, clock, {}}, {});
  ASSERT_TRUE(task.outcome().has_value());
  EXPECT_EQ(task.outcome()->error, ErrorCode::kCameraNoFrames);
  ASSERT_GE(camera.exposures_us.size(), 3U);
  EXPECT_NE(camera.exposures_us[1], 2000.0) << "the second look has another exposure";
  EXPECT_EQ(camera.exposures_us.back(), 2000.0);
}

}  // namespace
}  // namespace fvd
