/// How many refusals the log tells of.

#include "daemon/access/refused_calls.hpp"

#include <chrono>
#include <cstdint>
#include <string>

#include "gtest/gtest.h"

namespace fvd {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

TEST(RefusedCalls, AreToldOnceASecondWithTheirNumber) {
  RefusedCalls refused;
  const HostTime begin{seconds(1000)};
  EXPECT_EQ(refused.count_to_tell("a", begin), 1U);
  for (int i = 1; i < 1000; ++i) EXPECT_FALSE(refused.count_to_tell("a", begin + milliseconds(i)));
  EXPECT_EQ(refused.count_to_tell("b", begin + milliseconds(999)), 1000U) << "another caller, and what was not told";
  EXPECT_EQ(refused.count_to_tell("a", begin + seconds(1)), 1U);
}

TEST(RefusedCalls, AreKnownOfTheLatestCallers) {
  RefusedCalls refused;
  HostTime now{seconds(1000)};
  const auto last = std::to_string(RefusedCalls::kMostCallers);
  for (std::size_t i = 0; i <= RefusedCalls::kMostCallers; ++i) {
    EXPECT_TRUE(refused.count_to_tell(std::to_string(i), now += seconds(1)));
  }
  EXPECT_FALSE(refused.count_to_tell(last, now));
  EXPECT_EQ(refused.count_to_tell("0", now), 2U) << "it gave way";
}

TEST(RefusedCalls, AreToldAFewTimesASecondFromHoweverManyAddresses) {
  RefusedCalls refused;
  const HostTime begin{seconds(1000)};
  std::size_t told = 0;
  std::uint64_t counted = 0;
  for (int i = 0; i < 5000; ++i) {
    const auto count = refused.count_to_tell(std::to_string(i), begin + milliseconds(i));
    told += count ? 1 : 0;
    counted += count.value_or(0);
  }
  EXPECT_EQ(told, 5 * RefusedCalls::kMostAPause);
  counted += refused.count_to_tell("0", begin + seconds(10)).value_or(0);
  EXPECT_EQ(counted, 5001U) << "none is lost";
}

}  // namespace
}  // namespace fvd
