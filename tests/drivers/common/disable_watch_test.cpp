#include "drivers/common/disable_watch.hpp"

#include "gtest/gtest.h"

namespace fvd {
namespace {

using std::chrono::milliseconds;

AxisSample seen(bool enabled, bool moving, milliseconds from_now) {
  AxisSample sample;
  sample.begun = sample.time = HostClock::now() + from_now;
  sample.enabled = enabled;
  sample.moving = moving;
  return sample;
}

TEST(DisableWatch, BlamesNobodyForADriveThatWasNeverEnabled) {
  const DisableWatch watch;
  EXPECT_FALSE(watch.somebody_else_disabled(seen(false, false, milliseconds(0))));
}

TEST(DisableWatch, ExplainsADisabledDriveByAStopOnce) {
  DisableWatch watch;
  watch.enabled();
  EXPECT_TRUE(watch.somebody_else_disabled(seen(false, false, milliseconds(0))));
  watch.stopping(seen(true, true, milliseconds(0)));
  EXPECT_FALSE(watch.somebody_else_disabled(seen(false, false, milliseconds(0)))) << "the stop did it";
  watch.saw(seen(true, false, milliseconds(200)));
  EXPECT_FALSE(watch.somebody_else_disabled(seen(false, false, milliseconds(200)))) << "it may still do it";
  watch.saw(seen(true, false, milliseconds(1000)));
  EXPECT_TRUE(watch.somebody_else_disabled(seen(false, false, milliseconds(1100)))) << "the stop left it enabled";
}

TEST(DisableWatch, WaitsForTheEndOfALongBraking) {
  DisableWatch watch;
  watch.enabled();
  watch.stopping(seen(true, true, milliseconds(0)));
  watch.saw(seen(true, true, milliseconds(900)));
  watch.saw(seen(true, false, milliseconds(1000)));
  EXPECT_FALSE(watch.somebody_else_disabled(seen(false, false, milliseconds(1001))));
}

TEST(DisableWatch, IsNotSatisfiedByAStopOfADriveThatWasDisabledBefore) {
  DisableWatch watch;
  watch.enabled();
  watch.stopping(seen(false, false, milliseconds(0)));
  EXPECT_TRUE(watch.somebody_else_disabled(seen(false, false, milliseconds(0))));
}

}  // namespace
}  // namespace fvd
