#pragma once

/// A scan plan for frames that identify their exposure.

#include "tests/support/camera_fault_case.hpp"

namespace fvd::test {

/// Slices 1 um apart, from 0 on.
inline ScanPlan marked_plan(int slices) {
  ScanPlan plan = camera_fault_plan();
  plan.step = Micrometers{1.0};
  plan.slices = slices;
  return plan;
}

}  // namespace fvd::test
