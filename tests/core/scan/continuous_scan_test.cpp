/// Continuous scans on doubles whose time passes only when the camera is asked for a frame.

#include "core/scan/continuous_scan.hpp"

#include <vector>

#include <gtest/gtest.h>

#include "core/base/error.hpp"
#include "tests/core/scan/sweeping_devices.hpp"
#include "tests/support/expect_error.hpp"

namespace fvd {
namespace {

using std::chrono::microseconds;
using test::Fate;
using test::FreeCamera;
using test::HeightSink;
using test::SweepingStage;
using test::TestClock;

class AContinuousScan : public testing::Test {
 protected:
  AContinuousScan() {
    plan_.mode = ScanMode::kContinuous;
    plan_.start = Micrometers{0.0};
    plan_.step = Micrometers{2.0};
    plan_.slices = 51;
    plan_.speed_um_per_s = 400.0;
    settings_.exposure_us = 2000.0;
  }
  /// 1 um apart at 200 um/s; rate: of the camera, as a fraction of what is asked for.
  void run_at(int slices, double rate) {
    plan_.start = Micrometers{-300.0};
    plan_.step = Micrometers{1.0};
    plan_.speed_um_per_s = 200.0;
    plan_.slices = slices;
    camera_.rate_factor = rate;
    report_ = {};
    sink_.z_um.clear();
    run();
  }
  void run(std::stop_token stop = {}) {
    FreeRun free_run(camera_, settings_);
    ContinuousScan({camera_, stage_, clock_, sink_}, free_run).run(plan_, report_, on_slice_, stop);
  }

  TestClock clock_;
  SweepingStage stage_{clock_};
  FreeCamera camera_{clock_, stage_};
  HeightSink sink_;
  ScanPlan plan_;
  CameraSettings settings_;
  ScanReport report_;
  std::function<void(const ScanReport&)> on_slice_;
};

TEST_F(AContinuousScan, TakesEverySliceAtTheHeightOfItsMidExposure) {
  run();
  ASSERT_GE(sink_.z_um.size(), 50U);
  ASSERT_LE(sink_.z_um.size(), 51U);
  for (std::size_t i = 0; i < sink_.z_um.size(); ++i) {
    EXPECT_NEAR(sink_.z_um[i], stage_.true_um(sink_.starts[i] + std::chrono::milliseconds(1)), 1e-6) << i;
    if (i > 0) {
      EXPECT_NEAR(sink_.z_um[i] - sink_.z_um[i - 1], 2.0, 1e-3) << "constant speed: no ramp among the slices";
    }
  }
  EXPECT_GE(sink_.z_um.front(), -1.0);
  EXPECT_LE(sink_.z_um.back(), 101.0);
  EXPECT_GT(report_.ramp_frames, 0);
  EXPECT_TRUE(report_.frames.balanced());
  EXPECT_EQ(report_.frames.ok, sink_.z_um.size());
  EXPECT_EQ(report_.steps.size(), sink_.z_um.size());
  EXPECT_EQ(camera_.trigger_mode(), TriggerMode::kSoftware) << "quiet between scans";
}

TEST_F(AContinuousScan, GoesDownwardsForTheCalibration) {
  plan_.downwards = true;
  run();
  ASSERT_GE(sink_.z_um.size(), 50U);
  EXPECT_GT(sink_.z_um.front(), sink_.z_um.back());
}

TEST_F(AContinuousScan, CorrectsTheOffsetOfTheClocks) {
  stage_.lag = microseconds(1000);
  plan_.time_offset = microseconds(1000);
  run();
  ASSERT_GE(sink_.z_um.size(), 50U);
  for (std::size_t i = 0; i < sink_.z_um.size(); ++i) {
    EXPECT_NEAR(sink_.z_um[i], stage_.true_um(sink_.starts[i] + std::chrono::milliseconds(1)), 1e-6) << i;
  }
}

TEST_F(AContinuousScan, FailsForALostSliceUnlessTheRecipeAllowsIt) {
  camera_.plan(49.0, 51.0, Fate::kNothing);
  test::expect_error(ErrorCode::kCameraFramesLost, {"1 of 51 slices were lost"}, [this] { run(); });
  EXPECT_TRUE(report_.frames.balanced());
  EXPECT_EQ(report_.frames.missing, 1U);
  EXPECT_EQ(stage_.stops, 1);
  EXPECT_EQ(camera_.trigger_mode(), TriggerMode::kSoftware);
}

TEST_F(AContinuousScan, TellsMissingFromIncompleteFromUnderrun) {
  camera_.plan(19.0, 21.0, Fate::kNothing);
  camera_.plan(39.0, 41.0, Fate::kIncomplete);
  camera_.plan(59.0, 61.0, Fate::kUnderrun);
  plan_.allowed_lost_slices = 3;
  run();
  EXPECT_EQ(report_.frames.missing, 1U);
  EXPECT_EQ(report_.frames.incomplete, 1U);
  EXPECT_EQ(report_.frames.underrun, 1U);
  EXPECT_TRUE(report_.frames.balanced());
  EXPECT_EQ(report_.frames.ok, sink_.z_um.size());
}

TEST_F(AContinuousScan, CountsWhatIsLostAtTheEnds) {
  camera_.plan(-3.0, 3.0, Fate::kNothing);    // one ramp frame and the first slices
  camera_.plan(97.0, 105.0, Fate::kNothing);  // the last slices and ramp frames
  plan_.allowed_lost_slices = 10;
  run();
  EXPECT_TRUE(report_.frames.balanced());
  EXPECT_GE(report_.frames.missing, 3U);
  EXPECT_LE(report_.frames.missing, 5U);
}

TEST_F(AContinuousScan, FailsIfTheCameraIsTooSlowWithoutAGapInItsIds) {
  plan_.slices = 101;
  plan_.allowed_lost_slices = 3;
  camera_.rate_factor = 0.9;  // 91 frames come
  test::expect_error(ErrorCode::kCameraFramesLost, {"4 of 101 slices were lost"}, [this] { run(); });
  EXPECT_TRUE(report_.frames.balanced());
  EXPECT_EQ(report_.frames.missing, 4U);
}

TEST_F(AContinuousScan, BooksAsManySlicesAsWerePlannedIfTheCameraIsTooSlow) {
  plan_.slices = 101;
  plan_.allowed_lost_slices = 20;
  camera_.rate_factor = 0.9;
  run();
  EXPECT_EQ(report_.frames.expected, 101U);
  EXPECT_NEAR(static_cast<double>(report_.frames.ok), 91.0, 1.0);
  EXPECT_EQ(report_.frames.ok, sink_.z_um.size());
  EXPECT_EQ(report_.frames.ok + report_.frames.missing, 101U);
  for (std::size_t i = 0; i < report_.steps.size(); ++i) {
    EXPECT_NEAR(report_.steps[i].index, report_.steps[i].measured_um / 2.0, 2.0) << "slices keep their place " << i;
  }
}

TEST_F(AContinuousScan, BooksASliceThatWasNotExposed) {
  camera_.plan(49.0, 51.0, Fate::kNotExposed);
  test::expect_error(ErrorCode::kCameraFramesLost, {"1 of 51 slices were lost"}, [this] { run(); });
  EXPECT_EQ(report_.frames.missing, 1U);
}

TEST_F(AContinuousScan, BooksWhatWasNotExposedAtTheEnds) {
  camera_.plan(-3.0, 3.0, Fate::kNotExposed);
  camera_.plan(97.0, 105.0, Fate::kNotExposed);
  plan_.allowed_lost_slices = 10;
  run();
  EXPECT_TRUE(report_.frames.balanced());
  EXPECT_EQ(report_.frames.expected, 51U);
  EXPECT_GE(report_.frames.missing, 3U);
  EXPECT_LE(report_.frames.missing, 5U);
}

/// Frames lie anywhere between two targets, and no clock is exact: one more or less at the ends is no loss.
TEST_F(AContinuousScan, LosesNothingToAFrameMoreOrLessAtTheEnds) {
  for (const double rate : {0.995, 1.0, 1.005}) {
    for (const double start_um : {0.0, 0.3, 0.6, 0.9, 1.2, 1.5, 1.8}) {
      camera_.rate_factor = rate;
      plan_.start = Micrometers{start_um};
      report_ = {};
      sink_.z_um.clear();
      run();
      EXPECT_EQ(report_.frames.missing, 0U) << rate << " from " << start_um;
      EXPECT_GE(sink_.z_um.size(), 50U) << rate << " from " << start_um;
      EXPECT_LE(sink_.z_um.size(), 51U) << rate << " from " << start_um;
    }
  }
}

TEST_F(AContinuousScan, LosesNothingToASpeedOrRateThatIsAFewPercentOff) {
  for (const int slices : {51, 101, 401}) {
    for (const double rate : {0.97, 0.98, 0.99}) {
      run_at(slices, rate);
      EXPECT_EQ(report_.frames.missing, 0U) << slices << " slices at " << rate;
      EXPECT_NEAR(static_cast<double>(sink_.z_um.size()), rate * slices, 1.5) << slices << " slices at " << rate;
    }
  }
}

TEST_F(AContinuousScan, CoversTheWholeWayWithACameraThatIsAFewPercentTooFast) {
  for (const int slices : {51, 101, 401}) {
    for (const double rate : {1.01, 1.02, 1.04}) {
      run_at(slices, rate);
      EXPECT_GE(sink_.z_um.back(), plan_.highest().value - 1.0) << slices << " slices at " << rate;
      EXPECT_EQ(report_.frames.missing, 0U) << slices << " slices at " << rate;
      EXPECT_NEAR(static_cast<double>(sink_.z_um.size()), rate * slices, 2.0) << slices << " slices at " << rate;
      EXPECT_TRUE(report_.frames.balanced());
    }
  }
}

TEST_F(AContinuousScan, BooksWhatIsLostOfACameraThatIsTooFast) {
  plan_.slices = 401;
  plan_.start = Micrometers{-300.0};
  plan_.step = Micrometers{1.0};
  plan_.speed_um_per_s = 200.0;
  plan_.allowed_lost_slices = 20;
  camera_.rate_factor = 1.04;
  camera_.plan(90.0, 97.0, Fate::kNotExposed);  // 390 to 397 of 400 um: as many as were planned are there before
  run();
  EXPECT_NEAR(static_cast<double>(report_.frames.missing), 7.0, 1.5);
  EXPECT_GE(sink_.z_um.back(), 99.0);
}

TEST_F(AContinuousScan, BooksTheEndThatACameraThatIsTooFastDidNotExpose) {
  plan_.slices = 401;
  plan_.start = Micrometers{-300.0};
  plan_.step = Micrometers{1.0};
  plan_.speed_um_per_s = 200.0;
  camera_.rate_factor = 1.04;
  camera_.plan(92.0, 500.0, Fate::kNotExposed);
  test::expect_error(ErrorCode::kCameraFramesLost, {"of 401 slices were lost"}, [this] { run(); });
}

TEST_F(AContinuousScan, FailsIfTheCameraIsMuchFasterThanAsked) {
  camera_.rate_factor = 2.0;
  test::expect_error(ErrorCode::kCameraSettings, {"faster than asked", "cover all 100 um"}, [this] { run(); });
}

TEST_F(AContinuousScan, FailsWithoutAnyFrame) {
  camera_.plan(-1000.0, 1000.0, Fate::kNothing);
  test::expect_error(ErrorCode::kCameraFramesLost, {"51 of 51"}, [&] { run(); });
}

TEST_F(AContinuousScan, LosesNothingToRampsThatAreDamaged) {
  camera_.plan(-500.0, -3.0, Fate::kIncomplete);
  run();
  EXPECT_EQ(report_.frames.incomplete, 0U);
  EXPECT_TRUE(report_.frames.balanced());
}

TEST_F(AContinuousScan, EndsWithTheReasonOfStageOrCamera) {
  stage_.alarm = true;
  test::expect_error(ErrorCode::kStageAlarm, {"alarm"}, [&] { run(); });
  EXPECT_EQ(camera_.trigger_mode(), TriggerMode::kSoftware);
  stage_.alarm = false;
  camera_.plan(40.0, 41.0, Fate::kGone);
  camera_.plan(41.0, 44.0, Fate::kGone);
  report_ = {};
  test::expect_error(ErrorCode::kCameraDisconnected, {"unplugged"}, [&] { run(); });
  EXPECT_TRUE(report_.frames.balanced());
}

TEST_F(AContinuousScan, CanBeAborted) {
  std::stop_source stop;
  on_slice_ = [&](const ScanReport& report) {
    if (report.steps.size() == 10) stop.request_stop();
  };
  test::expect_error(ErrorCode::kAborted, {"stopped"}, [&] { run(stop.get_token()); });
  EXPECT_EQ(report_.steps.size(), 10U);
  EXPECT_GE(stage_.stops, 1);
}

TEST_F(AContinuousScan, IsRefusedBeforeAnythingMoves) {
  const auto refused = [this](ErrorCode code, const char* text) {
    test::expect_error(code, {text}, [&] { run(); });
    EXPECT_EQ(stage_.to_um, 0.0);
  };
  settings_.exposure_us = 3000.0;
  refused(ErrorCode::kBadRecipe, "333.3");
  settings_.exposure_us = 2000.0;
  plan_.max_blur_steps = 2.0;
  settings_.exposure_us = 6000.0;
  refused(ErrorCode::kBadRecipe, "frames per second");
  settings_.exposure_us = 2000.0;
  plan_.speed_um_per_s = 1001.0;
  refused(ErrorCode::kBadRecipe, "speed");
  plan_.speed_um_per_s = 400.0;
  plan_.start = Micrometers{-490.0};
  refused(ErrorCode::kStageLimit, "run-up");
  plan_.start = Micrometers{0.0};
  stage_.feedback = FeedbackSource::kNone;
  refused(ErrorCode::kBadRecipe, "measures its position");
}

}  // namespace
}  // namespace fvd
