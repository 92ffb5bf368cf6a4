#include "core/scan/reference.hpp"

#include <chrono>
#include <optional>

#include "core/base/error.hpp"
#include "core/scan/scan_runner.hpp"
#include "gtest/gtest.h"
#include "sim/fakes/fakes.hpp"
#include "tests/support/expect_error.hpp"

namespace fvd {
namespace {

using std::chrono::milliseconds;

/// Tells what it was seen like, and counts the questions.
class WatchedAxis final : public sim::FakeAxis {
 public:
  using FakeAxis::FakeAxis;
  StageStatus status() override {
    ++questions;
    if (is_lost) throw Error(ErrorCode::kStageDisconnected, "the axis is lost");
    return FakeAxis::status();
  }
  [[nodiscard]] std::optional<StageStatus> last_seen() const override { return seen; }

  std::optional<StageStatus> seen;
  bool is_lost = false;
  int questions = 0;
};

class AReference : public testing::Test {
 protected:
  AReference() {
    clock_.advance_to(clock_.now() + std::chrono::hours(1));
    see(true, milliseconds(0));
  }
  void see(bool homed, milliseconds ago) {
    StageStatus status;
    status.homed = homed;
    status.sampled = clock_.now() - ago;
    axis_.seen = status;
  }

  sim::FakeClock clock_;
  WatchedAxis axis_{clock_};
};

TEST_F(AReference, ThatWasSeenAMomentAgoIsNotAskedFor) {
  see(true, milliseconds(60));
  EXPECT_TRUE(has_reference(axis_, clock_));
  EXPECT_EQ(axis_.questions, 0);
}

TEST_F(AReference, IsAskedForWhereNobodySamplesTheAxis) {
  axis_.seen.reset();
  EXPECT_TRUE(has_reference(axis_, clock_));
  axis_.is_homed = false;
  EXPECT_FALSE(has_reference(axis_, clock_));
  EXPECT_EQ(axis_.questions, 2);
}

TEST_F(AReference, ThatWasNotSeenMayHaveComeSince) {
  see(false, milliseconds(1));
  EXPECT_TRUE(has_reference(axis_, clock_)) << "as at the end of a homing";
  axis_.is_homed = false;
  EXPECT_FALSE(has_reference(axis_, clock_));
}

TEST_F(AReference, ThatWasSeenLongAgoIsAskedFor) {
  see(true, milliseconds(201));
  axis_.is_homed = false;
  EXPECT_FALSE(has_reference(axis_, clock_));
}

TEST_F(AReference, OfALostAxisIsAskedForWhichTellsTheLoss) {
  axis_.seen->state = AxisState::kCommLost;
  axis_.is_lost = true;
  FVD_EXPECT_ERROR(kStageDisconnected, (void)has_reference(axis_, clock_));
}

TEST_F(AReference, ThatIsKnownLetsAScanBeginWithItsFirstMotion) {
  sim::FakeCamera camera(clock_, 4, 3, {});
  sim::SpySink sink;
  ScanPlan plan;
  plan.slices = 3;
  plan.step = Micrometers{10.0};
  ScanReport report;
  std::optional<int> questions;
  axis_.on_move = [&] {
    if (!questions) questions = axis_.questions;
  };
  ScanRunner({camera, axis_, clock_, sink}).run(plan, report, {}, {});
  EXPECT_EQ(questions, 0);
  EXPECT_EQ(report.steps.size(), 3U);

  see(false, milliseconds(0));
  axis_.is_homed = false;
  FVD_EXPECT_ERROR(kStageNotHomed, ScanRunner({camera, axis_, clock_, sink}).run(plan, report, {}, {}));
}

}  // namespace
}  // namespace fvd
