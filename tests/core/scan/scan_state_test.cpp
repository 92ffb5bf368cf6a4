#include "core/scan/scan_state.hpp"

#include <map>
#include <utility>

#include "gtest/gtest.h"

namespace fvd {
namespace {

using S = ScanState;
using E = ScanEvent;

// The table of the header, typed again.
const std::map<std::pair<S, E>, S> kAllowed{
    {{S::kPreoperational, E::kDevicesUp}, S::kInitialized},
    {{S::kPreoperational, E::kDevicesDown}, S::kError},
    {{S::kPreoperational, E::kHalt}, S::kHalted},
    {{S::kInitialized, E::kDevicesUp}, S::kInitialized},
    {{S::kInitialized, E::kDevicesDown}, S::kError},
    {{S::kInitialized, E::kRecipePrepared}, S::kReady},
    {{S::kInitialized, E::kJobStarted}, S::kExecuting},
    {{S::kInitialized, E::kTaskStarted}, S::kExecuting},
    {{S::kInitialized, E::kHalt}, S::kHalted},
    {{S::kReady, E::kDevicesUp}, S::kReady},
    {{S::kReady, E::kDevicesDown}, S::kError},
    {{S::kReady, E::kRecipePrepared}, S::kReady},
    {{S::kReady, E::kJobStarted}, S::kExecuting},
    {{S::kReady, E::kTaskStarted}, S::kExecuting},
    {{S::kReady, E::kHalt}, S::kHalted},
    {{S::kExecuting, E::kJobEnded}, S::kReady},
    {{S::kExecuting, E::kDevicesDown}, S::kError},
    {{S::kExecuting, E::kJobStarted}, S::kExecuting},
    {{S::kExecuting, E::kTaskEnded}, S::kInitialized},
    {{S::kExecuting, E::kTaskEndedPrepared}, S::kReady},
    {{S::kExecuting, E::kHalt}, S::kHalted},
    {{S::kError, E::kDevicesUp}, S::kInitialized},
    {{S::kError, E::kDevicesDown}, S::kError},
    {{S::kError, E::kHalt}, S::kHalted},
    {{S::kHalted, E::kHalt}, S::kHalted},
};

TEST(ScanState, FollowsItsTableForEveryStateAndEvent) {
  for (const S state : kAllScanStates) {
    for (const E event : kAllScanEvents) {
      const auto expected = kAllowed.find({state, event});
      const auto actual = next_state(state, event);
      if (expected == kAllowed.end()) {
        EXPECT_FALSE(actual.has_value()) << scan_state_name(state) << " event " << static_cast<int>(event);
      } else {
        ASSERT_TRUE(actual.has_value()) << scan_state_name(state) << " event " << static_cast<int>(event);
        EXPECT_EQ(*actual, expected->second) << scan_state_name(state) << " event " << static_cast<int>(event);
      }
    }
  }
}

TEST(ScanState, NamesAreThoseOfTheStandard) {
  EXPECT_EQ(scan_state_name(S::kPreoperational), "preoperational");
  EXPECT_EQ(scan_state_name(S::kExecuting), "executing");
  EXPECT_EQ(scan_state_name(S::kHalted), "halted");
}

}  // namespace
}  // namespace fvd
