#include "drivers/common/position_log.hpp"

#include "core/scan/settle_detector.hpp"
#include "gtest/gtest.h"

namespace fvd {
namespace {

using std::chrono::milliseconds;

HostTime at(int ms) { return HostTime(milliseconds(ms)); }

PositionLog log_of(int samples) {
  PositionLog log(8);
  for (int i = 0; i < samples; ++i) log.add({.time = at(10 * i), .position = Micrometers{1.0 * i}});
  return log;
}

TEST(PositionLog, AveragesTheSamplesInsideTheWindow) {
  const PositionMean mean = log_of(6).mean(at(10), at(30));
  EXPECT_EQ(mean.samples, 3);
  EXPECT_DOUBLE_EQ(mean.mean.value, 2.0);
  EXPECT_DOUBLE_EQ(mean.sd.value, 1.0);
}

TEST(PositionLog, InterpolatesWhereNoSampleLiesInside) {
  const PositionMean mean = log_of(6).mean(at(22), at(28));
  EXPECT_EQ(mean.samples, 0);
  EXPECT_DOUBLE_EQ(mean.mean.value, 2.5);
}

TEST(PositionLog, TakesTheNearestOutsideItsRange) {
  EXPECT_DOUBLE_EQ(log_of(6).mean(at(100), at(110)).mean.value, 5.0);
  EXPECT_DOUBLE_EQ(log_of(12).mean(at(0), at(10)).mean.value, 4.0) << "older samples were overwritten";
}

TEST(SettleDetector, WantsConsecutiveSamplesOverTheDwell) {
  SettleDetector detector(Micrometers{10.0}, {.window = Micrometers{0.5}, .samples = 3, .dwell = milliseconds(20)});
  EXPECT_FALSE(detector.add(at(0), Micrometers{10.1}, true));
  EXPECT_FALSE(detector.add(at(5), Micrometers{10.6}, true)) << "ringing left the window";
  EXPECT_FALSE(detector.add(at(10), Micrometers{10.0}, true));
  EXPECT_FALSE(detector.add(at(20), Micrometers{10.0}, true));
  EXPECT_FALSE(detector.add(at(25), Micrometers{10.0}, true)) << "three samples, but the dwell is not over";
  EXPECT_TRUE(detector.add(at(30), Micrometers{10.0}, true));
}

TEST(SettleDetector, DoesNotTrustAPositionInMotion) {
  SettleDetector detector(Micrometers{10.0}, {.window = Micrometers{0.5}, .samples = 1, .dwell = milliseconds(0)});
  EXPECT_FALSE(detector.add(at(0), Micrometers{10.0}, false));
  EXPECT_TRUE(detector.add(at(1), Micrometers{10.0}, true));
}

}  // namespace
}  // namespace fvd
