#include "daemon/jobs/device_commands.hpp"

#include <cerrno>
#include <filesystem>
#include <iterator>
#include <stop_token>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "daemon/export/file_calls.hpp"
#include "daemon/export/preview_hub.hpp"
#include "gtest/gtest.h"
#include "sim/fakes/fakes.hpp"
#include "tests/support/scratch_dir.hpp"

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

TEST(AnImageThatSomebodyTakes, IsKeptForWhoLooksOn) {
  const test::ScratchDir folder;
  sim::FakeClock clock;
  SettingsCamera camera(clock, 48, 32);
  sim::FakeAxis stage(clock);
  PreviewHub pictures;
  const auto done = [&](DeviceTask::Work work) {
    DeviceTask task(std::move(work));
    task.run({camera, stage, clock, folder.path(), nullptr, &pictures}, {});
    const DeviceTask::Outcome outcome =
        task.outcome().value_or(DeviceTask::Outcome{{}, ErrorCode::kInternal, "it did not end"});
    EXPECT_EQ(outcome.error, std::nullopt) << outcome.message;
    return nlohmann::json::parse(outcome.json, nullptr, false);
  };

  const auto preview = done(preview_work({}));
  const auto first = pictures.newest_picture();
  (void)done(snap_work({}));
  const auto second = pictures.newest_picture();

  ASSERT_TRUE(first && second);
  EXPECT_EQ(preview["seq"], 1);
  EXPECT_EQ(preview["width_px"], 48);
  EXPECT_EQ(first->seq, 1U);
  EXPECT_EQ(first->image_width_px, 48);
  EXPECT_EQ(first->image_height_px, 32);
  EXPECT_EQ(second->seq, 2U);
}

class NothingIsUnlinked final : public FileCalls {
 public:
  int unlink(const std::filesystem::path& path) override {
    asked.push_back(path.filename());
    errno = EPERM;
    return -1;
  }
  std::vector<std::string> asked;
};

TEST(Snap, IsToldThoughAnOldPictureCannotBeRemoved) {
  const test::ScratchDir folder;
  const std::filesystem::path snaps = folder / "snaps";
  std::filesystem::create_directories(snaps / "a.png");  // no picture: it stays, and does not count
  for (int i = 1; i <= 101; ++i) {
    test::write_text(snaps / ("20200101T" + std::to_string(100000 + i) + "Z-1.png"), "");
  }
  sim::FakeClock clock;
  SettingsCamera camera(clock, 16, 16);
  sim::FakeAxis stage(clock);
  const auto snap = [&] {
    DeviceTask task(snap_work({}));
    task.run({camera, stage, clock, folder.path()}, {});
    return task.outcome().value_or(DeviceTask::Outcome{{}, ErrorCode::kInternal, "it did not end"});
  };
  {
    NothingIsUnlinked calls;
    const ReplacedFileCalls replaced(calls);
    EXPECT_EQ(snap().error, std::nullopt);
    EXPECT_THAT(calls.asked, testing::ElementsAre("20200101T100001Z-1.png", "20200101T100002Z-1.png"));
  }
  const DeviceTask::Outcome outcome = snap();
  EXPECT_EQ(outcome.error, std::nullopt) << outcome.message;
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(snaps), {}), 101) << "a hundred, and the folder";
}

}  // namespace
}  // namespace fvd
