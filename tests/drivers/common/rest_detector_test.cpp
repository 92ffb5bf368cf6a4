#include "drivers/common/rest_detector.hpp"

#include "gtest/gtest.h"

namespace fvd {
namespace {

using std::chrono::milliseconds;

constexpr Micrometers kWindow{1.0};
constexpr HostTime kStart{std::chrono::seconds(1)};

TEST(RestDetector, WantsThreeLooksOverFiftyMilliseconds) {
  RestDetector rest(kWindow);
  EXPECT_FALSE(rest.add(kStart, Micrometers{3.0}, true));
  EXPECT_FALSE(rest.add(kStart + milliseconds(20), Micrometers{3.4}, true));
  EXPECT_FALSE(rest.add(kStart + milliseconds(49), Micrometers{2.6}, true));
  EXPECT_TRUE(rest.add(kStart + milliseconds(50), Micrometers{3.0}, true));
  EXPECT_FALSE(rest.saw_motion());

  RestDetector slow(kWindow);
  EXPECT_FALSE(slow.add(kStart, Micrometers{3.0}, true));
  EXPECT_FALSE(slow.add(kStart + milliseconds(500), Micrometers{3.0}, true)) << "two looks are none, however far apart";
  EXPECT_TRUE(slow.add(kStart + milliseconds(1000), Micrometers{3.0}, true));
}

TEST(RestDetector, BeginsAnewAtEveryReportOfMotion) {
  RestDetector rest(kWindow);
  EXPECT_FALSE(rest.add(kStart, Micrometers{0.0}, true));
  EXPECT_FALSE(rest.add(kStart + milliseconds(30), Micrometers{0.0}, true));
  EXPECT_FALSE(rest.add(kStart + milliseconds(60), Micrometers{0.0}, false));
  EXPECT_TRUE(rest.saw_motion());
  EXPECT_FALSE(rest.add(kStart + milliseconds(70), Micrometers{0.0}, true));
  EXPECT_FALSE(rest.add(kStart + milliseconds(90), Micrometers{0.0}, true));
  EXPECT_TRUE(rest.add(kStart + milliseconds(120), Micrometers{0.0}, true));
}

TEST(RestDetector, BelievesNoAxisThatCreepsAndReportsRest) {
  RestDetector rest(kWindow);
  // 0.4 um a look is within the window of the look before, and not within that of the first.
  for (int look = 0; look < 100; ++look) {
    EXPECT_FALSE(rest.add(kStart + look * milliseconds(20), Micrometers{0.4 * look}, true)) << look;
  }
  EXPECT_TRUE(rest.saw_motion());
}

TEST(RestDetector, TakesTwoStepsOfACoarseEncoderForOnePlace) {
  EXPECT_EQ(rest_window(Micrometers{0.05}), Micrometers{1.0});
  EXPECT_EQ(rest_window(Micrometers{5.0}), Micrometers{10.0});
}

TEST(RestDetector, AllowsTheBrakingFromFullSpeedAndTwoSeconds) {
  EXPECT_EQ(standstill_timeout(500.0, 1000.0), milliseconds(2500));
  EXPECT_EQ(standstill_timeout(500.0, 0.0), milliseconds(2000));
}

}  // namespace
}  // namespace fvd
