#include "daemon/jobs/device_commands.hpp"

#include <stop_token>
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
    if (exposures_us.size() == stop_at) stop.request_stop();
    return FakeCamera::configure(settings);
  }
  std::vector<double> exposures_us;
  std::size_t stop_at = 0;  ///< configure() that somebody stops, from 1 on
  std::stop_source stop;
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

TEST(SuggestExposure, AsksNothingMoreOfTheCameraOnceItIsStopped) {
  sim::FakeClock clock;
  SettingsCamera camera(clock, 16, 16);
  camera.stop_at = 2;
  sim::FakeAxis stage(clock);
  CameraSettings settings;
  settings.exposure_us = 2000.0;
  DeviceTask task(exposure_work(settings, 0.7));
  task.run({camera, stage, clock, {}}, camera.stop.get_token());
  ASSERT_TRUE(task.outcome().has_value());
  EXPECT_EQ(task.outcome()->error, ErrorCode::kAborted);
  EXPECT_EQ(camera.exposures_us.size(), 2U);
}

TEST(Snap, SetsNoCameraUpOnceItIsStopped) {
  sim::FakeClock clock;
  SettingsCamera camera(clock, 16, 16);
  camera.stop.request_stop();
  sim::FakeAxis stage(clock);
  DeviceTask task(snap_work({}));
  task.run({camera, stage, clock, {}}, camera.stop.get_token());
  ASSERT_TRUE(task.outcome().has_value());
  EXPECT_EQ(task.outcome()->error, ErrorCode::kAborted);
  EXPECT_TRUE(camera.exposures_us.empty());
}

}  // namespace
}  // namespace fvd
