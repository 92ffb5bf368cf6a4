#include "core/scan/slice_capture.hpp"

#include <deque>

#include "core/base/error.hpp"
#include "gtest/gtest.h"
#include "sim/fakes/fakes.hpp"

namespace fvd {
namespace {

using sim::FakeCamera;
using sim::FakeClock;
using sim::TriggerOutcome;

/// Somebody stops the scan while it waits.
class StoppingClock final : public Clock {
 public:
  StoppingClock(const FakeClock& clock, std::stop_source& stop) : clock_(clock), stop_(stop) {}
  [[nodiscard]] HostTime now() const override { return clock_.now(); }
  void wait_until(HostTime /*deadline*/, std::stop_token /*stop*/) override {
    ++waits;
    stop_.request_stop();
  }
  int waits = 0;

 private:
  const FakeClock& clock_;
  std::stop_source& stop_;
};

class ASliceCapture : public testing::Test {
 protected:
  /// Captures `slices` slices one after the other with 3 retries; returns how many were had.
  int capture(std::deque<TriggerOutcome> script, int slices) {
    FakeCamera camera(clock_, 4, 3, std::move(script));
    SliceCapture capture(camera, clock_, ledger_);
    int had = 0;
    for (int i = 0; i < slices; ++i) {
      clock_.advance_to(clock_.now() + std::chrono::milliseconds(50));
      const HostTime settled = clock_.now();
      const auto captured = capture.capture(settled, 3, {});
      EXPECT_TRUE(ledger_.counts().balanced());
      if (!captured) continue;
      ++had;
      triggers_.push_back(captured->triggers);
      contents_.push_back(captured->frame.image.as<std::uint8_t>().at(0, 0));
      EXPECT_GE(captured->frame.exposure_start, settled);
    }
    EXPECT_EQ(camera.frames_lent(), 0) << "every frame goes back to the pool";
    return had;
  }

  FakeClock clock_;
  FrameLedger ledger_;
  std::vector<int> triggers_;
  std::vector<int> contents_;
};

TEST_F(ASliceCapture, TakesGoodFramesAtTheFirstTrigger) {
  EXPECT_EQ(capture({}, 3), 3);
  EXPECT_EQ(triggers_, (std::vector{1, 1, 1}));
  EXPECT_EQ(ledger_.counts(), (FrameCounts{.expected = 3, .ok = 3}));
}

TEST_F(ASliceCapture, RetriesALostFrame) {
  EXPECT_EQ(capture({TriggerOutcome::kFrame, TriggerOutcome::kNothing}, 3), 3);
  EXPECT_EQ(triggers_, (std::vector{1, 2, 1}));
  EXPECT_EQ(ledger_.counts(), (FrameCounts{.expected = 4, .ok = 3, .missing = 1}));
}

TEST_F(ASliceCapture, RetriesADamagedFrame) {
  EXPECT_EQ(capture({TriggerOutcome::kIncomplete, TriggerOutcome::kWrongGeometry}, 1), 1);
  EXPECT_EQ(triggers_, (std::vector{3}));
  EXPECT_EQ(ledger_.counts(), (FrameCounts{.expected = 3, .ok = 1, .incomplete = 2}));
}

TEST_F(ASliceCapture, TakesALateFrameOfTheSameHeightAndDiscardsTheRetrysOwn) {
  EXPECT_EQ(capture({TriggerOutcome::kLate, TriggerOutcome::kFrame}, 2), 2);
  EXPECT_EQ(contents_, (std::vector{1, 3})) << "trigger 2's frame is stale by the time of slice 2";
  EXPECT_EQ(ledger_.counts(), (FrameCounts{.expected = 3, .ok = 2, .stale = 1}));
}

TEST_F(ASliceCapture, NeverTakesAFrameExposedBeforeTheStageSettled) {
  EXPECT_EQ(capture({TriggerOutcome::kTooEarly}, 1), 1);
  EXPECT_EQ(contents_, (std::vector{2}));
  EXPECT_EQ(ledger_.counts().ok, 1U);
  EXPECT_EQ(ledger_.counts().stale, 1U);
}

TEST_F(ASliceCapture, CountsARepeatedFrameAsStale) {
  EXPECT_EQ(capture({TriggerOutcome::kTwice}, 2), 2);
  EXPECT_EQ(contents_, (std::vector{1, 2}));
  EXPECT_EQ(ledger_.counts(), (FrameCounts{.expected = 3, .ok = 2, .stale = 1}));
}

TEST_F(ASliceCapture, TellsAnUnderrunFromAMissingFrame) {
  EXPECT_EQ(capture({TriggerOutcome::kUnderrun}, 1), 1);
  EXPECT_EQ(ledger_.counts(), (FrameCounts{.expected = 2, .ok = 1, .underrun = 1}));
}

TEST_F(ASliceCapture, GivesUpAfterItsRetries) {
  EXPECT_EQ(capture(std::deque<TriggerOutcome>(4, TriggerOutcome::kNothing), 1), 0);
  EXPECT_EQ(ledger_.counts(), (FrameCounts{.expected = 4, .missing = 4}));
}

/// The error after a slice that was lost with these outcomes.
ErrorCode failure_after(FakeClock& clock, TriggerOutcome outcome, int retries) {
  FakeCamera camera(clock, 4, 3, std::deque<TriggerOutcome>(static_cast<std::size_t>(retries) + 1, outcome));
  FrameLedger ledger;
  SliceCapture capture(camera, clock, ledger);
  EXPECT_FALSE(capture.capture(clock.now(), retries, {}).has_value());
  return capture.failure("slice 3").code();
}

TEST_F(ASliceCapture, TellsACameraThatDeliversNothingFromOneThatLosesFrames) {
  EXPECT_EQ(failure_after(clock_, TriggerOutcome::kNothing, 3), ErrorCode::kCameraNoFrames);
  EXPECT_EQ(failure_after(clock_, TriggerOutcome::kIncomplete, 3), ErrorCode::kCameraFramesLost);
  EXPECT_EQ(failure_after(clock_, TriggerOutcome::kUnderrun, 3), ErrorCode::kCameraFramesLost);
  EXPECT_EQ(failure_after(clock_, TriggerOutcome::kNothing, 0), ErrorCode::kCameraFramesLost)
      << "one frame may get lost";
}

/// By the end of its exposure, as some cameras date it: the end that the scan knows lies in the future.
TEST_F(ASliceCapture, HandsAFrameOutWhenItsExposureIsOver) {
  FakeCamera camera(clock_, 4, 3);
  camera.clock_error = std::chrono::milliseconds(40);
  SliceCapture capture(camera, clock_, ledger_);
  const auto captured = capture.capture(clock_.now(), 0, {});
  ASSERT_TRUE(captured.has_value());
  EXPECT_GE(clock_.now(), captured->frame.exposure_end);
}

TEST_F(ASliceCapture, EndsItsWaitForAnExposureAfterAStopRequest) {
  FakeCamera camera(clock_, 4, 3);
  camera.clock_error = std::chrono::hours(1);
  std::stop_source stop;
  StoppingClock clock(clock_, stop);
  SliceCapture capture(camera, clock, ledger_);
  try {
    (void)capture.capture(clock_.now(), 0, stop.get_token());
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kAborted);
  }
  EXPECT_EQ(clock.waits, 1);
}

TEST_F(ASliceCapture, PassesOnThatTheCameraIsGone) {
  FakeCamera camera(clock_, 4, 3, {TriggerOutcome::kDisconnect});
  SliceCapture capture(camera, clock_, ledger_);
  try {
    (void)capture.capture(clock_.now(), 3, {});
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kCameraDisconnected);
  }
}

TEST_F(ASliceCapture, EndsWithAbortedAfterAStopRequest) {
  FakeCamera camera(clock_, 4, 3);
  SliceCapture capture(camera, clock_, ledger_);
  std::stop_source stop;
  stop.request_stop();
  try {
    (void)capture.capture(clock_.now(), 3, stop.get_token());
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kAborted);
  }
  EXPECT_EQ(camera.triggers(), 0);
}

}  // namespace
}  // namespace fvd
