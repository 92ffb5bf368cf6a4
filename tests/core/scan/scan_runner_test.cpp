#include "core/scan/scan_runner.hpp"

#include "core/base/error.hpp"
#include "core/stage/stage_accuracy.hpp"
#include "gtest/gtest.h"
#include "sim/fakes/fakes.hpp"
#include "tests/support/expect_error.hpp"

namespace fvd {
namespace {

using sim::FakeAxis;
using sim::FakeCamera;
using sim::FakeClock;
using sim::SpySink;
using sim::TriggerOutcome;

class AScan : public testing::Test {
 protected:
  AScan() {
    plan_.start = Micrometers{-7.0};
    plan_.step = Micrometers{10.0};
    plan_.slices = 5;
  }

  void run(std::deque<TriggerOutcome> script = {}, std::stop_token stop = {}) {
    FakeCamera camera(clock_, 4, 3, std::move(script));
    camera.clock_error = camera_clock_error_;
    ScanRunner runner({camera, stage_, clock_, sink_});
    runner.run(
        plan_, report_, [this](const ScanReport& report) { progress_.push_back(report.steps.size()); }, stop);
  }

  ErrorCode run_expecting_error(std::deque<TriggerOutcome> script = {}, std::stop_token stop = {}) {
    try {
      run(std::move(script), stop);
    } catch (const Error& error) {
      message_ = error.what();
      return error.code();
    }
    ADD_FAILURE() << "the scan did not fail";
    return ErrorCode::kInternal;
  }

  FakeClock clock_;
  FakeAxis stage_{clock_};
  SpySink sink_;
  std::chrono::microseconds camera_clock_error_{0};
  ScanPlan plan_;
  ScanReport report_;
  std::vector<std::size_t> progress_;
  std::string message_;
};

TEST_F(AScan, TakesUpTheBacklashBelowAndThenGoesOneWay) {
  run();
  EXPECT_EQ(stage_.targets_um, (std::vector{-27.0, -7.0, 3.0, 13.0, 23.0, 33.0}));
}

TEST_F(AScan, DownwardsTakesUpTheBacklashAboveAndVisitsTheSamePlaces) {
  plan_.downwards = true;

  run();

  EXPECT_EQ(stage_.targets_um, (std::vector{53.0, 33.0, 23.0, 13.0, 3.0, -7.0}));
  EXPECT_EQ(sink_.z_um, (std::vector{33.0, 23.0, 13.0, 3.0, -7.0}));
  EXPECT_EQ(report_.steps.front().index, 0) << "in the order of the scan";
}

TEST_F(AScan, DownwardsNeedsRoomForItsTakeUpAbove) {
  plan_.downwards = true;
  plan_.start = Micrometers{-500.0};
  run();
  EXPECT_EQ(stage_.targets_um.back(), -500.0) << "and none below";
  plan_.start = Micrometers{441.0};

  EXPECT_EQ(run_expecting_error(), ErrorCode::kStageLimit);
  EXPECT_NE(message_.find("take-up above"), std::string::npos) << message_;
  EXPECT_NE(message_.find("441..501"), std::string::npos) << message_;
}

TEST_F(AScan, HandsOnMeasuredNotCommandedHeights) {
  stage_.error_um = 0.25;
  run();
  EXPECT_EQ(sink_.z_um, (std::vector{-6.75, 3.25, 13.25, 23.25, 33.25}));
  EXPECT_DOUBLE_EQ(report_.steps[2].commanded_um, 13.0);
  EXPECT_DOUBLE_EQ(report_.steps[2].measured_um, 13.25);
  EXPECT_DOUBLE_EQ(report_.steps[2].error_um, 0.25);
}

TEST_F(AScan, UsesTheCommandedHeightWhereNothingMeasuresIt) {
  stage_.description.feedback = FeedbackSource::kNone;
  stage_.error_um = 0.25;
  run();
  EXPECT_EQ(sink_.z_um.front(), -7.0);
}

TEST_F(AScan, TakesNoHeightFromBeforeTheStageHadSettled) {
  camera_clock_error_ = std::chrono::microseconds(-150);
  run();
  EXPECT_EQ(report_.frames.ok, 5U);
  EXPECT_FALSE(stage_.mean_moved) << "the trigger came after the stage had settled, whatever the camera's clock says";
}

TEST_F(AScan, AccountsForEveryFrameAndReportsProgress) {
  run({TriggerOutcome::kFrame, TriggerOutcome::kNothing});
  EXPECT_EQ(report_.frames, (FrameCounts{.expected = 6, .ok = 5, .missing = 1}));
  EXPECT_EQ(report_.steps[1].triggers, 2);
  EXPECT_EQ(progress_, (std::vector<std::size_t>{1, 2, 3, 4, 5}));
}

TEST_F(AScan, FailsWhenASliceIsLost) {
  plan_.frame_retries = 1;
  EXPECT_EQ(run_expecting_error({TriggerOutcome::kFrame, TriggerOutcome::kNothing, TriggerOutcome::kIncomplete}),
            ErrorCode::kCameraFramesLost);
  EXPECT_NE(message_.find("slice 1 at 3 um"), std::string::npos) << message_;
  EXPECT_EQ(stage_.stops, 1) << "the stage is stopped on an error";
  EXPECT_EQ(report_.frames, (FrameCounts{.expected = 3, .ok = 1, .incomplete = 1, .missing = 1}));
}

TEST_F(AScan, GoesOnWithinTheLostSlicesTheRecipeAllows) {
  plan_.frame_retries = 0;
  plan_.allowed_lost_slices = 1;
  run({TriggerOutcome::kFrame, TriggerOutcome::kNothing});
  EXPECT_EQ(sink_.z_um, (std::vector{-7.0, 13.0, 23.0, 33.0})) << "a lost slice is a gap in z, not a shift";
  EXPECT_FALSE(report_.steps[1].measured);
  EXPECT_TRUE(report_.steps[2].measured);
}

TEST_F(AScan, FailsWhenTheQueueRefusesASlice) {
  sink_.refuse_at = 2;
  EXPECT_EQ(run_expecting_error(), ErrorCode::kSliceLost);
}

TEST_F(AScan, RefusesToLeaveTheLimitsBeforeAnythingMoves) {
  plan_.start = Micrometers{-490.0};
  EXPECT_EQ(run_expecting_error(), ErrorCode::kStageLimit) << "the take-up counts";
  plan_.start = Micrometers{470.0};
  EXPECT_EQ(run_expecting_error(), ErrorCode::kStageLimit);
  EXPECT_TRUE(stage_.targets_um.empty());
  EXPECT_NE(message_.find("450..510"), std::string::npos) << message_;
}

TEST_F(AScan, CountsTheWayBelowTheFirstSliceWhoseLineTriggerFails) {
  stage_.description.take_up = Micrometers{2.0};
  plan_.line_trigger = true;
  plan_.start = stage_.description.min + Micrometers{9.0};  // a step is 10

  FVD_EXPECT_ERROR(kStageLimit, check_plan(plan_, stage_.description));
  plan_.start = stage_.description.min + Micrometers{10.0};
  EXPECT_NO_THROW(check_plan(plan_, stage_.description));
  plan_.frame_retries = 0;
  plan_.start = stage_.description.min + Micrometers{2.0};
  EXPECT_NO_THROW(check_plan(plan_, stage_.description)) << "nobody comes back to a slice";
}

TEST_F(AScan, RefusesAnAxisWithoutReference) {
  stage_.is_homed = false;
  EXPECT_EQ(run_expecting_error(), ErrorCode::kStageNotHomed);
  EXPECT_TRUE(stage_.targets_um.empty());
}

TEST_F(AScan, StopsTheStageWhenTheCameraIsGone) {
  EXPECT_EQ(run_expecting_error({TriggerOutcome::kFrame, TriggerOutcome::kDisconnect}), ErrorCode::kCameraDisconnected);
  EXPECT_EQ(stage_.stops, 1);
}

TEST_F(AScan, ReportsAnAxisThatDoesNotSettle) {
  stage_.fail_at_um = 13.0;
  EXPECT_EQ(run_expecting_error(), ErrorCode::kStagePosition);
  EXPECT_EQ(report_.steps.size(), 2U);
}

TEST_F(AScan, EndsWithAbortedOnAStopRequest) {
  std::stop_source stop;
  stage_.on_move = [&] {
    if (stage_.targets_um.size() == 3) stop.request_stop();
  };
  EXPECT_EQ(run_expecting_error({}, stop.get_token()), ErrorCode::kAborted);
  EXPECT_EQ(stage_.stops, 1);
}

TEST(StepSummary, CondensesTheMeasuredSteps) {
  StepLog log(4);
  const double errors[] = {0.1, -0.1, 0.3, 0.1};
  for (std::size_t i = 0; i < log.size(); ++i) {
    log[i].error_um = errors[i];
    log[i].move_ms = 40.0 + static_cast<double>(i);
  }
  const auto summary = summarize_steps(log);
  EXPECT_EQ(summary.steps, 4);
  EXPECT_NEAR(summary.error_mean_um, 0.1, 1e-12);
  EXPECT_NEAR(summary.error_sd_um, 0.16329931618, 1e-9);
  EXPECT_NEAR(summary.error_max_um, 0.3, 1e-12);
  EXPECT_NEAR(summary.increment_error_max_um, 0.4, 1e-12);
  EXPECT_NEAR(summary.move_median_ms, 41.5, 1e-12);
  EXPECT_NEAR(summary.move_max_ms, 43.0, 1e-12);
}

TEST(StepSummary, SkipsIncrementsAcrossALostSlice) {
  StepLog log(3);
  log[0].error_um = 5.0;
  log[1].measured = false;
  const auto summary = summarize_steps(log);
  EXPECT_EQ(summary.steps, 2);
  EXPECT_EQ(summary.increment_error_max_um, 0.0);
}

TEST(StepSummary, IsZeroForAnEmptyLog) { EXPECT_EQ(summarize_steps({}).steps, 0); }

}  // namespace
}  // namespace fvd
