/// Every fault of the camera in the middle of a scan: no wrong slice is believed, none is lost unnoticed, and the scan
/// ends as it should.

#include <gtest/gtest.h>

#include "tests/support/camera_fault_case.hpp"

namespace fvd::test {
namespace {

class ACameraFault : public testing::TestWithParam<CameraFaultCase> {};

TEST_P(ACameraFault, FalsifiesNoSlice) {
  const CameraFaultCase& fault = GetParam();
  const CameraFaultOutcome outcome = run_camera_fault_case(fault);
  SCOPED_TRACE(outcome.story);
  RecordProperty("story", outcome.story);
  EXPECT_EQ(outcome.wrong, 0);
  EXPECT_EQ(outcome.unbalanced, 0);
  EXPECT_EQ(outcome.end, fault.end);
  EXPECT_EQ(outcome.unconsumed, 0U) << "the fault did not happen";
  if (!fault.end) {
    EXPECT_EQ(outcome.slices, 2 * kCameraFaultSlices);
  }
  // Generous: the machine may be busy. tests/bench/run_camera.sh tells what is usual.
  EXPECT_LT(outcome.end_ms, 3000.0);
  EXPECT_LT(outcome.recover_ms, 8000.0);
}

INSTANTIATE_TEST_SUITE_P(All, ACameraFault, testing::ValuesIn(camera_fault_cases()),
                         [](const auto& of) { return std::string(of.param.name); });

}  // namespace
}  // namespace fvd::test
