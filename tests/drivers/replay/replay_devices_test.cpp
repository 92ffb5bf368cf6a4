#include "drivers/replay/replay_devices.hpp"

#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/scan/scan_runner.hpp"
#include "tests/support/expect_error.hpp"
#include "tests/support/scratch_dir.hpp"
#include "tests/support/stack_folder.hpp"

namespace fvd {
namespace {

using test::expect_error;
using test::pattern_slice;
using test::ScratchDir;

constexpr HostTime kNow = HostTime::min();

class AReplayedStack : public testing::Test {
 protected:
  AReplayedStack() {
    test::write_stack(scratch_.path(), "s", ".png", 5, 2);  // z = 0 10 20 30 40 um
    camera_config_.replay_dir = scratch_.path();
    stage_config_.replay_dir = scratch_.path();
    settings_.pool_frames = 3;
  }

  [[nodiscard]] int first_level(const Frame& frame) const { return frame.image.as<std::uint8_t>().at(3, 4); }
  [[nodiscard]] int recorded_level(int slice) const { return pattern_slice(slice, 2).at<std::uint8_t>(4, 3); }

  ScratchDir scratch_;
  CameraConfig camera_config_;
  StageConfig stage_config_;
  CameraSettings settings_;
  SettleCriterion criterion_;
};

TEST_F(AReplayedStack, ShowsTheSliceWhereTheStageStands) {
  const auto camera = open_replay_camera(camera_config_);
  const auto stage = open_replay_stage(stage_config_);
  camera->configure(settings_);
  for (const int slice : {3, 0, 4}) {
    const MoveRecord move = stage->move_to(Micrometers{10.0 * slice + 0.2}, criterion_, {});
    EXPECT_EQ(move.position.value, 10.0 * slice) << "the recorded height, not the target";
    camera->trigger();
    const auto frame = camera->next_frame(kNow);
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->status, FrameStatus::kOk);
    EXPECT_GE(frame->exposure_start, move.settled);
    EXPECT_EQ(first_level(*frame), recorded_level(slice));
    EXPECT_EQ(stage->mean_position(frame->exposure_start, frame->exposure_end).mean.value, 10.0 * slice);
  }
}

class KeepSlices final : public SliceSink {
 public:
  bool push(Slice&& slice, HostTime /*deadline*/, std::stop_token /*stop*/) override {
    z_um.push_back(slice.z_um);
    levels.push_back(slice.frame.image.as<std::uint8_t>().at(3, 4));
    return true;
  }
  std::vector<double> z_um;
  std::vector<int> levels;
};

TEST_F(AReplayedStack, ServesAWholeScan) {
  const auto stage = open_replay_stage(stage_config_);
  const auto camera = open_replay_camera(camera_config_);
  camera->configure(settings_);
  SystemClock clock;
  KeepSlices kept;
  ScanPlan plan;
  plan.start = Micrometers{0};
  plan.step = Micrometers{10};
  plan.slices = 5;
  ScanReport report;
  ScanRunner({*camera, *stage, clock, kept}).run(plan, report, {}, {});
  EXPECT_EQ(kept.z_um, (std::vector<double>{0, 10, 20, 30, 40}));
  for (int i = 0; i < 5; ++i) EXPECT_EQ(kept.levels[static_cast<std::size_t>(i)], recorded_level(i));
  EXPECT_EQ(report.frames.ok, 5U);
  EXPECT_TRUE(report.frames.balanced());
}

TEST_F(AReplayedStack, IsStampedSimulated) {
  EXPECT_TRUE(open_replay_camera(camera_config_)->info().simulated);
  EXPECT_TRUE(open_replay_stage(stage_config_)->info().simulated);
}

TEST_F(AReplayedStack, TakesItsHeightsFromAFile) {
  test::write_text(scratch_ / "z.txt", "0.001\n0.002\n0.004\n0.008\n0.016\n");
  stage_config_.replay_z_file = scratch_ / "z.txt";
  stage_config_.replay_z_unit = "mm";
  const auto stage = open_replay_stage(stage_config_);
  EXPECT_EQ(stage->move_to(Micrometers{7.6}, criterion_, {}).position.value, 8.0);
  stage_config_.replay_z_unit = "inch";
  expect_error(ErrorCode::kBadConfig, {"stage.replay_z_unit", "inch"}, [&] { (void)open_replay_stage(stage_config_); });
}

TEST_F(AReplayedStack, RefusesTargetsItHasNoSliceFor) {
  const auto stage = open_replay_stage(stage_config_);
  expect_error(ErrorCode::kStagePosition, {"14", "10"}, [&] { stage->move_to(Micrometers{14}, criterion_, {}); });
  expect_error(ErrorCode::kStageLimit, {"46"}, [&] { stage->move_to(Micrometers{46}, criterion_, {}); });
  expect_error(ErrorCode::kStageLimit, {"-6"}, [&] { stage->move_to(Micrometers{-6}, criterion_, {}); });
  stage_config_.max = Micrometers{25};
  expect_error(ErrorCode::kStageLimit, {"30"},
               [&] { open_replay_stage(stage_config_)->move_to(Micrometers{30}, criterion_, {}); });
}

TEST_F(AReplayedStack, DoesNotMoveAfterAStop) {
  std::stop_source stop;
  stop.request_stop();
  const auto stage = open_replay_stage(stage_config_);
  expect_error(ErrorCode::kAborted, {}, [&] { stage->move_to(Micrometers{20}, criterion_, stop.get_token()); });
  EXPECT_EQ(stage->status().position.value, 0.0);
}

TEST_F(AReplayedStack, RefusesSettingsThatItsSlicesDoNotHave) {
  const auto camera = open_replay_camera(camera_config_);
  EXPECT_EQ(camera->configure(settings_).width, 40);
  CameraSettings wrong = settings_;
  wrong.width = 41;
  expect_error(ErrorCode::kCameraSettings, {"40 x 30", "41"}, [&] { camera->configure(wrong); });
  wrong = settings_;
  wrong.pixel_format = SensorFormat::kMono16;
  expect_error(ErrorCode::kCameraSettings, {"8 bit", "16 bit"}, [&] { camera->configure(wrong); });
  wrong = settings_;
  wrong.offset_y = 1;
  expect_error(ErrorCode::kCameraSettings, {"offset"}, [&] { camera->configure(wrong); });
  wrong = settings_;
  wrong.pool_frames = 0;
  expect_error(ErrorCode::kCameraSettings, {"pool"}, [&] { camera->configure(wrong); });
}

TEST_F(AReplayedStack, CountsAnUnderrunWhenAllFramesAreLent) {
  const auto camera = open_replay_camera(camera_config_);
  camera->configure(settings_);
  std::vector<Frame> held;
  for (int i = 0; i < 3; ++i) {
    camera->trigger();
    held.push_back(std::move(*camera->next_frame(kNow)));
  }
  camera->trigger();
  EXPECT_FALSE(camera->next_frame(kNow));
  EXPECT_EQ(camera->health().underruns, 1U);
  held.pop_back();
  camera->trigger();
  EXPECT_TRUE(camera->next_frame(kNow));
}

TEST_F(AReplayedStack, NamesTheSliceThatBecameUnreadable) {
  const auto camera = open_replay_camera(camera_config_);
  camera->configure(settings_);
  test::write_text(scratch_ / "s0.png", "no image");
  expect_error(ErrorCode::kBadInput, {"s0.png"}, [&] { camera->trigger(); });
  EXPECT_FALSE(camera->next_frame(kNow));
  test::write_stack(scratch_.path(), "s", ".png", 1, 2);
  camera->trigger();
  EXPECT_TRUE(camera->next_frame(kNow)) << "the slot of the failed one came back";
}

TEST_F(AReplayedStack, EndsAWaitWhenInterrupted) {
  const auto camera = open_replay_camera(camera_config_);
  camera->configure(settings_);
  const std::jthread other([&] { camera->interrupt(); });
  EXPECT_FALSE(camera->next_frame(HostClock::now() + std::chrono::minutes(10)));  // the test's own limit is shorter
}

TEST_F(AReplayedStack, ForgetsAnInterruptOfBeforeItWasConfigured) {
  const auto camera = open_replay_camera(camera_config_);
  camera->configure(settings_);
  camera->interrupt();
  camera->configure(settings_);
  const HostTime deadline = HostClock::now() + std::chrono::milliseconds(30);
  EXPECT_FALSE(camera->next_frame(deadline)) << "nothing was triggered";
  EXPECT_GE(HostClock::now(), deadline) << "the wait was not cut short";
}

TEST_F(AReplayedStack, MustBeTriggeredAfterConfiguration) {
  expect_error(ErrorCode::kCameraSettings, {"configured"}, [&] { open_replay_camera(camera_config_)->trigger(); });
}

TEST(ReplayDevices, NeedAFolder) {
  expect_error(ErrorCode::kBadConfig, {"camera.replay_dir"}, [] { (void)open_replay_camera({}); });
  expect_error(ErrorCode::kBadConfig, {"stage.replay_dir"}, [] { (void)open_replay_stage({}); });
}

TEST(ReplayDevices, OfTwoRecordingsDoNotMeet) {
  const ScratchDir scratch;
  test::write_stack(scratch / "a", "s", ".png", 3, 1);
  test::write_stack(scratch / "b", "s", ".png", 3, 1);
  CameraConfig camera_config;
  camera_config.replay_dir = scratch / "a";
  StageConfig here;
  here.replay_dir = scratch / "a/../a/";  // the same folder by another name
  StageConfig elsewhere;
  elsewhere.replay_dir = scratch / "b";
  const auto camera = open_replay_camera(camera_config);
  const auto stage = open_replay_stage(here);
  const auto other = open_replay_stage(elsewhere);
  stage->move_to(Micrometers{10}, {}, {});
  other->move_to(Micrometers{20}, {}, {});
  camera->configure({});
  camera->trigger();
  EXPECT_EQ(camera->next_frame(kNow)->image.as<std::uint8_t>().at(3, 4), pattern_slice(1, 1).at<std::uint8_t>(4, 3));
}

}  // namespace
}  // namespace fvd
