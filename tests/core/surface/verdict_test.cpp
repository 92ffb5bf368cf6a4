#include "core/surface/verdict.hpp"

#include <array>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace fvd {
namespace {

TEST(Verdict, PassesWithinTheLimitsAndOnThem) {
  const Limits limits{1.0, 2.0};
  EXPECT_EQ(judge(1.0, limits), Verdict::kPass);
  EXPECT_EQ(judge(1.5, limits), Verdict::kPass);
  EXPECT_EQ(judge(2.0, limits), Verdict::kPass);
}

TEST(Verdict, FailsOutsideTheLimits) {
  const Limits limits{1.0, 2.0};
  EXPECT_EQ(judge(std::nextafter(1.0, 0.0), limits), Verdict::kFail);
  EXPECT_EQ(judge(std::nextafter(2.0, 3.0), limits), Verdict::kFail);
}

TEST(Verdict, DoesNotJudgeAnOpenSide) {
  EXPECT_EQ(judge(-1e300, {std::nullopt, 2.0}), Verdict::kPass);
  EXPECT_EQ(judge(1e300, {1.0, std::nullopt}), Verdict::kPass);
  EXPECT_EQ(judge(0.0, {}), Verdict::kPass);
}

TEST(Verdict, IsInvalidWithoutAFiniteValue) {
  EXPECT_EQ(judge(std::nullopt, {}), Verdict::kInvalid);
  EXPECT_EQ(judge(std::nan(""), {1.0, 2.0}), Verdict::kInvalid);
  EXPECT_EQ(judge(std::numeric_limits<double>::infinity(), {1.0, std::nullopt}), Verdict::kInvalid);
}

TEST(Verdict, OnAllIsTheWorst) {
  using enum Verdict;
  EXPECT_EQ(joined_verdict({}), std::nullopt);
  EXPECT_EQ(joined_verdict(std::array{kPass, kPass}), kPass);
  EXPECT_EQ(joined_verdict(std::array{kPass, kInvalid}), kInvalid);
  EXPECT_EQ(joined_verdict(std::array{kInvalid, kFail, kPass}), kFail);
}

TEST(Verdict, OnAllIsUncertainWhereNothingWorseIs) {
  using enum Verdict;
  EXPECT_EQ(joined_verdict(std::array{kPass, kUncertain, kPass}), kUncertain);
  EXPECT_EQ(joined_verdict(std::array{kUncertain, kInvalid}), kInvalid);
  EXPECT_EQ(joined_verdict(std::array{kUncertain, kFail}), kFail);
}

TEST(Verdict, OfAPartCountsInvalidAsTheWorst) {
  using enum Verdict;
  EXPECT_EQ(worst_verdict({}), std::nullopt);
  EXPECT_EQ(worst_verdict(std::array{kPass, kPass}), kPass);
  EXPECT_EQ(worst_verdict(std::array{kPass, kUncertain}), kUncertain);
  EXPECT_EQ(worst_verdict(std::array{kUncertain, kFail, kPass}), kFail);
  EXPECT_EQ(worst_verdict(std::array{kFail, kInvalid, kUncertain}), kInvalid);
}

TEST(Verdict, IsReadBackFromItsName) {
  for (const Verdict verdict : {Verdict::kPass, Verdict::kFail, Verdict::kInvalid, Verdict::kUncertain}) {
    EXPECT_EQ(verdict_from_name(verdict_name(verdict)), verdict);
  }
  EXPECT_EQ(verdict_from_name("good"), std::nullopt);
  EXPECT_EQ(verdict_from_name(""), std::nullopt);
}

}  // namespace
}  // namespace fvd
