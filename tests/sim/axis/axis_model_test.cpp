#include "sim/axis/axis_model.hpp"

#include <cmath>
#include <numbers>

#include "gtest/gtest.h"
#include "sim/axis/axis_motion.hpp"

namespace fvd::sim {
namespace {

using std::chrono::duration_cast;

HostTime after(HostTime start, double seconds) {
  return start + duration_cast<HostClock::duration>(std::chrono::duration<double>(seconds));
}

TEST(MotionProfile, TakesTheTimeOfATrapezoid) {
  // 1 mm/s, 20 mm/s^2: 50 ms up, 50 ms down over 50 um, the rest at full speed.
  const auto profile = MotionProfile::to({0.0, 0.0}, 250.0, {1000.0, 20000.0, 20000.0});
  EXPECT_NEAR(profile.duration(), 0.3, 1e-9);
  EXPECT_NEAR(profile.at(0.15).velocity, 1000.0, 1e-9);
  EXPECT_NEAR(profile.at(0.15).position, 125.0, 1e-9);
}

TEST(MotionProfile, TakesTheTimeOfATriangleWhenShort) {
  const auto profile = MotionProfile::to({0.0, 0.0}, -10.0, {1000.0, 20000.0, 20000.0});
  EXPECT_NEAR(profile.duration(), 2 * std::sqrt(10.0 / 20000.0), 1e-9);
  EXPECT_DOUBLE_EQ(profile.at(1.0).position, -10.0);
}

TEST(MotionProfile, RetargetsInFlightWithoutAJump) {
  const MotionLimits limits{1000.0, 20000.0, 20000.0};
  const auto first = MotionProfile::to({0.0, 0.0}, 250.0, limits);
  const MotionState state = first.at(0.1);
  for (const double target : {300.0, 60.0, -50.0, state.position}) {
    const auto second = MotionProfile::to(state, target, limits);
    EXPECT_NEAR(second.at(0.0).position, state.position, 1e-9);
    EXPECT_NEAR(second.at(0.0).velocity, state.velocity, 1e-6);
    EXPECT_NEAR(second.at(second.duration()).position, target, 1e-9);
    double last = state.position;
    for (double t = 0.0; t <= second.duration(); t += 1e-4) {
      const double position = second.at(t).position;
      EXPECT_LE(std::abs(position - last), 1000.0 * 1.1e-4) << "target " << target << " at " << t;
      last = position;
    }
  }
}

AxisParameters ideal() {
  AxisParameters parameters;
  parameters.power_on_position_um = 0.0;
  return parameters;
}

/// Moves there and returns a moment long after.
HostTime move(AxisModel& axis, HostTime start, double target_um) {
  axis.move_to(start, static_cast<std::int32_t>(std::lround(target_um * 100)), 1e5, 2e6, 2e6);
  return after(start, 2.0);
}

TEST(AxisModel, RestsWhereItWasSent) {
  AxisModel axis(ideal());
  const HostTime done = move(axis, HostClock::now(), 100.0);
  EXPECT_DOUBLE_EQ(axis.true_position_um(done), 100.0);
  EXPECT_EQ(axis.encoder_steps(done), 10000);
  EXPECT_FALSE(axis.moving(done));
}

TEST(AxisModel, IsNotHomedUntilItHasHomed) {
  AxisParameters parameters = ideal();
  parameters.power_on_position_um = -200.0;
  AxisModel axis(parameters);
  const HostTime start = HostClock::now();
  EXPECT_FALSE(axis.homed(start));
  EXPECT_EQ(axis.encoder_steps(start), 0) << "the drive counts from where it was switched on";
  axis.home(start);
  EXPECT_TRUE(axis.moving(after(start, 0.01)));
  EXPECT_FALSE(axis.homed(after(start, 0.01)));
  EXPECT_TRUE(axis.homed(after(start, 2.0)));
  EXPECT_NEAR(axis.true_position_um(after(start, 2.0)), 0.0, 1e-9);
  axis.power_cycle(after(start, 3.0));
  EXPECT_FALSE(axis.homed(after(start, 3.1)));
}

TEST(AxisModel, RingsAfterAMoveAndDecays) {
  AxisParameters parameters = ideal();
  parameters.ring_amplitude_um = 0.4;
  AxisModel axis(parameters);
  const HostTime start = HostClock::now();
  const double duration = 2 * std::sqrt(10.0 / 20000.0);
  move(axis, start, 10.0);
  const double quarter = 0.25 / parameters.ring_frequency_hz;
  EXPECT_NEAR(axis.true_position_um(after(start, duration + quarter)), 10.0 + 0.4 * std::exp(-1000 * quarter / 15.0),
              1e-6);
  EXPECT_NEAR(axis.true_position_um(after(start, duration + 0.3)), 10.0, 1e-6);
}

TEST(AxisModel, LosesBacklashOnReversalUnseenByTheEncoder) {
  AxisParameters parameters = ideal();
  parameters.backlash_um = 1.2;
  AxisModel axis(parameters);
  HostTime time = move(axis, HostClock::now(), 50.0);
  EXPECT_NEAR(axis.true_position_um(time), 50.0, 1e-9) << "loaded from below";
  time = move(axis, time, 40.0);
  EXPECT_NEAR(axis.true_position_um(time), 41.2, 1e-9);
  EXPECT_EQ(axis.encoder_steps(time), 4000);
  time = move(axis, time, 45.0);
  EXPECT_NEAR(axis.true_position_um(time), 45.0, 1e-9);
}

TEST(AxisModel, RepeatsItsLeadErrorEveryTurnOfTheScrew) {
  AxisParameters parameters = ideal();
  parameters.lead_error_um = 0.3;
  parameters.lead_um = 100.0;
  AxisModel axis(parameters);
  HostTime time = move(axis, HostClock::now(), 25.0);
  EXPECT_NEAR(axis.true_position_um(time), 25.3, 1e-9);
  time = move(axis, time, 125.0);
  EXPECT_NEAR(axis.true_position_um(time), 125.3, 1e-9);
  EXPECT_EQ(axis.encoder_steps(time), 12500);
}

TEST(AxisModel, ShiftsItsLeadErrorByAPhase) {
  AxisParameters parameters = ideal();
  parameters.lead_error_um = 0.3;
  parameters.lead_um = 100.0;
  parameters.lead_phase_deg = 90.0;
  AxisModel axis(parameters);
  HostTime time = HostClock::now();
  EXPECT_NEAR(axis.true_position_um(time), 0.3, 1e-9);
  time = move(axis, time, 50.0);
  EXPECT_NEAR(axis.true_position_um(time), 49.7, 1e-9);
}

TEST(AxisModel, ScalesItsMotion) {
  AxisParameters parameters = ideal();
  parameters.scale_error = 0.002;
  AxisModel axis(parameters);
  const HostTime time = move(axis, HostClock::now(), 100.0);
  EXPECT_NEAR(axis.true_position_um(time), 100.2, 1e-9);
  EXPECT_EQ(axis.encoder_steps(time), 10000) << "the motor does not know";
}

TEST(AxisModel, DriftsWithItsTemperature) {
  AxisParameters parameters = ideal();
  parameters.temperature_c = 21.0;
  parameters.temperature_rate_k_per_min = 0.5;
  parameters.drift_um_per_k = 3.5;
  const HostTime start = HostClock::now();
  AxisModel axis(parameters);
  const HostTime later = after(start, 120.0);
  EXPECT_NEAR(axis.temperature_c(later), 22.0, 0.1) << "two minutes, and the time to get here";
  EXPECT_NEAR(axis.true_position_um(later), 3.5 * (axis.temperature_c(later) - 21.0), 1e-9);
}

TEST(AxisModel, SeesItsTruePositionByALinearScale) {
  AxisParameters parameters = ideal();
  parameters.power_on_position_um = -200.0;
  parameters.feedback = Feedback::kLinearScale;
  parameters.backlash_um = 1.2;
  parameters.lead_error_um = 0.3;
  parameters.lead_um = 100.0;
  parameters.lead_phase_deg = 30.0;
  parameters.scale_error = 0.001;
  AxisModel axis(parameters);
  HostTime time = HostClock::now();
  axis.home(time);
  time = after(time, 2.0);
  EXPECT_EQ(axis.encoder_steps(time), 0) << "home is where the scale is 0";
  const double home = axis.true_position_um(time);
  for (const double target : {25.0, 80.0, 60.0}) {
    time = move(axis, time, target);
    EXPECT_NEAR(axis.encoder_steps(time), 100.0 * (axis.true_position_um(time) - home), 1.0) << target;
    EXPECT_EQ(axis.command_steps(time), static_cast<int>(100 * target));
  }
  EXPECT_GT(axis.encoder_steps(time), 6050) << "the backlash is seen";
}

TEST(AxisModel, DrawsItsRestingErrorsFromTheSeed) {
  AxisParameters parameters = ideal();
  parameters.settle_noise_um = 0.02;
  AxisModel a(parameters);
  AxisModel b(parameters);
  parameters.seed = 2;
  AxisModel c(parameters);
  const HostTime start = HostClock::now();
  double squares = 0.0;
  HostTime time = start;
  for (int i = 1; i <= 200; ++i) {
    move(b, time, i);
    move(c, time, i);
    const HostTime next = move(a, time, i);
    EXPECT_EQ(a.true_position_um(next), b.true_position_um(next));
    EXPECT_NE(a.true_position_um(next), c.true_position_um(next));
    squares += std::pow(a.true_position_um(next) - i, 2);
    time = next;
  }
  EXPECT_NEAR(std::sqrt(squares / 200), 0.02, 0.004);
}

TEST(AxisModel, ReportsStaleInPositionDuringItsStartLatency) {
  AxisParameters parameters = ideal();
  parameters.start_latency_ms = 3.0;
  AxisModel axis(parameters);
  const HostTime start = HostClock::now();
  move(axis, start, 10.0);
  EXPECT_TRUE(axis.in_position(after(start, 0.002)));
  EXPECT_TRUE(axis.moving(after(start, 0.010)));
}

}  // namespace
}  // namespace fvd::sim
