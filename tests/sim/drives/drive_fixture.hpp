#pragma once

/// A drive on an axis without errors, whose time runs when the test says so.

#include "gtest/gtest.h"
#include "sim/axis/axis_model.hpp"
#include "sim/drives/sim_drive.hpp"
#include "tests/sim/modbus/modbus_requests.hpp"

namespace fvd::sim::test {

template <typename Drive>
class DriveTest : public testing::Test {
 protected:
  DriveTest() : axis_(parameters()), drive_(axis_, [this] { return now_; }), client_(drive_) {}

  static AxisParameters parameters() {
    AxisParameters parameters;
    parameters.start_latency_ms = 3.0;
    return parameters;
  }

  void pass(std::chrono::microseconds time) { now_ += time; }
  void pass_ms(int ms) { now_ += std::chrono::milliseconds(ms); }
  /// Long after any motion of these tests.
  void rest() { now_ += std::chrono::seconds(20); }
  [[nodiscard]] bool moves() const { return axis_.moving(now_); }

  HostTime now_ = HostClock::now();
  AxisModel axis_;
  Drive drive_;
  BankClient client_;
};

}  // namespace fvd::sim::test
