#include "daemon/devices/standstill.hpp"

#include <deque>

#include "core/base/error.hpp"
#include "gtest/gtest.h"
#include "sim/fakes/fakes.hpp"
#include "tests/support/expect_error.hpp"

namespace fvd {
namespace {

struct Look {
  bool moving = false;
  double z_um = 0.0;
  bool enabled = true;
};

/// Shows its looks one after the other, the last one again and again.
class LookedAtAxis final : public sim::FakeAxis {
 public:
  LookedAtAxis(sim::FakeClock& clock, std::deque<Look> looks) : FakeAxis(clock), looks_(std::move(looks)) {}
  StageStatus status() override {
    if (looks_.empty()) throw Error(ErrorCode::kStageDisconnected, "gone");
    StageStatus status = FakeAxis::status();
    status.moving = looks_.front().moving;
    status.enabled = looks_.front().enabled;
    status.position = Micrometers{looks_.front().z_um};
    if (looks_.size() > 1) looks_.pop_front();
    return status;
  }

 private:
  std::deque<Look> looks_;
};

int ignore_motion = 0;

TEST(Standstill, IsFoundWhereTheAxisIs) {
  sim::FakeClock clock;
  LookedAtAxis axis(clock, {{false, 3.0}, {false, 3.5}});
  EXPECT_EQ(bring_to_rest(axis, clock, [] { ++ignore_motion; }), Micrometers{3.5});
  EXPECT_EQ(axis.stops, 0) << "an axis that rests is left alone";
}

TEST(Standstill, TellsAMovingAxisToStopOnceAndWaits) {
  sim::FakeClock clock;
  LookedAtAxis axis(clock, {{true, 0.0}, {true, 5.0}, {true, 9.0}, {false, 9.5}, {false, 9.5}});
  int seen = 0;
  EXPECT_TRUE(bring_to_rest(axis, clock, [&seen] { ++seen; }));
  EXPECT_EQ(axis.stops, 1);
  EXPECT_EQ(seen, 3);
}

TEST(Standstill, IsNotReportedOfAnAxisThatCreepsThoughItReportsRest) {
  sim::FakeClock clock;
  std::deque<Look> looks;
  for (int i = 0; i < 1000; ++i) looks.push_back({false, 2.0 * i});
  LookedAtAxis axis(clock, looks);
  EXPECT_FALSE(bring_to_rest(axis, clock, [] { ++ignore_motion; }));
  EXPECT_EQ(axis.stops, 1) << "it is told to stop all the same";
}

TEST(Standstill, IsSeenOfADriveWithoutTorqueThatReportsMotion) {
  sim::FakeClock clock;
  LookedAtAxis axis(clock, {{true, 3.0, false}, {true, 3.0, false}});
  EXPECT_TRUE(bring_to_rest(axis, clock, [] { ++ignore_motion; }));
  EXPECT_EQ(axis.stops, 0);
}

TEST(Standstill, IsNotReportedOfADriveWithoutTorqueThatCoasts) {
  sim::FakeClock clock;
  std::deque<Look> looks;
  for (int i = 0; i < 1000; ++i) looks.push_back({true, 2.0 * i, false});
  LookedAtAxis axis(clock, looks);
  EXPECT_FALSE(bring_to_rest(axis, clock, [] { ++ignore_motion; }));
}

TEST(Standstill, EndsItsWaitForAnAxisThatNeverStops) {
  sim::FakeClock clock;
  const HostTime began = clock.now();
  LookedAtAxis axis(clock, {{true, 0.0}});
  EXPECT_FALSE(bring_to_rest(axis, clock, [] { ++ignore_motion; }));
  EXPECT_EQ(axis.stops, 1);
  EXPECT_LE(clock.now() - began, std::chrono::milliseconds(1100));
}

TEST(Standstill, LeavesALostAxisToItsCaller) {
  sim::FakeClock clock;
  LookedAtAxis axis(clock, {});
  FVD_EXPECT_ERROR(kStageDisconnected, (void)bring_to_rest(axis, clock, [] { ++ignore_motion; }));
}

}  // namespace
}  // namespace fvd
