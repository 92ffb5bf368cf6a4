#include "daemon/transport/wrong_tokens.hpp"

#include <gtest/gtest.h>

namespace fvd {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

TEST(WrongTokens, WaitLongerEachTimeUpToALimit) {
  WrongTokens wrong;
  const HostTime now{seconds(1000)};
  milliseconds before = wrong.delay_of_another("10.0.0.7", now);
  EXPECT_EQ(before, WrongTokens::kFirstDelay);
  for (int i = 0; i < 5; ++i) {
    const milliseconds delay = wrong.delay_of_another("10.0.0.7", now);
    EXPECT_EQ(delay, 2 * before);
    before = delay;
  }
  for (int i = 0; i < 100; ++i) before = wrong.delay_of_another("10.0.0.7", now);
  EXPECT_EQ(before, WrongTokens::kLongestDelay);
  EXPECT_EQ(wrong.delay_of_another("10.0.0.8", now), WrongTokens::kFirstDelay) << "another place";
}

TEST(WrongTokens, AreForgotten) {
  WrongTokens wrong;
  HostTime now{seconds(1000)};
  (void)wrong.delay_of_another("a", now);
  now += WrongTokens::kForgotten;
  EXPECT_EQ(wrong.delay_of_another("a", now), 2 * WrongTokens::kFirstDelay);
  now += WrongTokens::kForgotten + milliseconds(1);
  EXPECT_EQ(wrong.delay_of_another("a", now), WrongTokens::kFirstDelay);
}

TEST(WrongTokens, RemembersTheLatestOfTooManyPlaces) {
  WrongTokens wrong;
  HostTime now{seconds(1000)};
  for (std::size_t i = 0; i <= WrongTokens::kMostPlaces; ++i) {
    (void)wrong.delay_of_another(std::to_string(i), now += milliseconds(1));
  }
  EXPECT_EQ(wrong.delay_of_another("1", now), 2 * WrongTokens::kFirstDelay);
  EXPECT_EQ(wrong.delay_of_another("0", now), WrongTokens::kFirstDelay) << "the oldest gave way";
}

}  // namespace
}  // namespace fvd
