/// Every drive, either line, every fault: no wrong value is believed, no motion runs twice, nothing hangs.

#include <tuple>

#include "gtest/gtest.h"
#include "tests/support/fault_case.hpp"

namespace fvd {
namespace {

using test::Transport;

class AStage : public testing::TestWithParam<std::tuple<test::DriveCase, Transport>> {};

TEST_P(AStage, BelievesNothingFalseWhateverFails) {
  const auto& [drive, transport] = GetParam();
  for (const test::FaultCase& fault : test::fault_cases()) {
    SCOPED_TRACE(fault.name);
    const test::FaultOutcome outcome = test::run_fault_case(drive, transport, fault);
    EXPECT_EQ(outcome.wrong_values, 0) << outcome.story;
    EXPECT_EQ(outcome.moves_too_many, 0) << outcome.story;
    EXPECT_EQ(outcome.errors, fault.ends_the_move ? 1 : 0) << outcome.story;
    EXPECT_EQ(outcome.unconsumed, 0U) << "the fault never happened";
  }
}

INSTANTIATE_TEST_SUITE_P(Of, AStage,
                         testing::Combine(testing::ValuesIn(test::kDriveCases),
                                          testing::Values(Transport::kTcp, Transport::kRtu)),
                         [](const auto& on) {
                           return testing::PrintToString(std::get<0>(on.param)) +
                                  testing::PrintToString(std::get<1>(on.param));
                         });

}  // namespace
}  // namespace fvd
