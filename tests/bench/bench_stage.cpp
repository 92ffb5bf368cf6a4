/// What the stage driver does on simulated drives: faults, steps, stops, and what the accuracy report finds of planted
/// errors. Prints tables; the last line is one JSON object.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <numbers>
#include <thread>

#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

#include "core/scan/stage_run.hpp"
#include "core/stage/stage_report.hpp"
#include "tests/bench/stage_fault_bench.hpp"
#include "tests/support/fault_case.hpp"

namespace fvd::test {
namespace {

using std::chrono::milliseconds;

double milliseconds_of(HostClock::duration time) { return std::chrono::duration<double, std::milli>(time).count(); }

// --- steps ---

struct StepFigures {
  double bias_um = 0.0;
  double sigma_um = 0.0;
  double step_ms = 0.0;  // mean of a hundred
};

constexpr SettleCriterion kCriterion{
    .window = Micrometers{0.5}, .samples = 3, .dwell = milliseconds(15), .timeout = milliseconds(3000)};
constexpr int kSteps = 100;
constexpr double kStep_um = 10.0;

/// A hundred settled steps of 10 um; errors are those of the true position against the target as the drive can have it.
StepFigures run_steps(const DriveCase& drive, Transport transport) {
  SimulatedDrive plant(drive, transport, good_axis(), transport == Transport::kRtu ? real_line() : sim::LineTiming{});
  const auto stage = plant.open_homed();
  stage->move_to(Micrometers{-20.0}, kCriterion, {});
  stage->move_to(Micrometers{0.0}, kCriterion, {});
  std::vector<double> errors;
  HostClock::duration time{};
  for (int i = 1; i <= kSteps; ++i) {
    const MoveRecord move = stage->move_to(Micrometers{kStep_um * i}, kCriterion, {});
    time += move.settled - move.started;
    const HostTime now = HostClock::now();
    const PositionMean measured = stage->mean_position(now, now + milliseconds(10));
    errors.push_back(measured.mean.value - move.target_quantised.value);
  }
  StepFigures figures;
  for (const double error : errors) figures.bias_um += error / kSteps;
  for (const double error : errors) figures.sigma_um += std::pow(error - figures.bias_um, 2) / (kSteps - 1);
  figures.sigma_um = std::sqrt(figures.sigma_um);
  figures.step_ms = milliseconds_of(time) / kSteps;
  std::printf("steps: %-9s %s  bias %+.4f um, sigma %.4f um, %.1f ms a step\n", drive.name,
              transport == Transport::kTcp ? "TCP" : "RTU", figures.bias_um, figures.sigma_um, figures.step_ms);
  return figures;
}

/// The drive's latency, a triangle of speed, and the dwell of the settle criterion.
double ideal_step_ms() {
  const StageConfig config;
  const double motion_ms = 2000.0 * std::sqrt(kStep_um / config.acceleration_um_per_s2);
  return good_axis().start_latency_ms + motion_ms + static_cast<double>(kCriterion.dwell.count());
}

// --- stop ---

/// From stop() to the moment at which the axis begins to slow down, over the response timeout; the worst over the
/// faults that befall a poll.
double run_stops() {
  double worst = 0.0;
  for (const Transport transport : {Transport::kTcp, Transport::kRtu}) {
    for (const FaultCase& fault : fault_cases()) {
      if (fault.step.on != sim::FaultOn::kRead || fault.ends_the_move) continue;
      SimulatedDrive plant(kDriveCases[0], transport, good_axis(),
                           transport == Transport::kRtu ? real_line() : sim::LineTiming{});
      const auto stage = plant.open_homed();
      std::jthread mover([&] {
        try {
          stage->move_to(Micrometers{1400.0}, kCriterion, {});
        } catch (const Error&) {  // it is stopped
        }
      });
      while (plant.axis().true_position_um(HostClock::now()) < 200.0) std::this_thread::yield();
      plant.faults().add(fault.step);
      while (plant.faults().unconsumed() > 0) std::this_thread::yield();
      const HostTime asked = HostClock::now();
      std::jthread stopper([&] { stage->stop(); });
      while (plant.axis().moving(HostClock::now())) std::this_thread::yield();
      const StageConfig config = plant.config();
      const double braking_ms = 1000.0 * config.speed_um_per_s / config.acceleration_um_per_s2;
      const double latency_ms = milliseconds_of(HostClock::now() - asked) - braking_ms;
      // A drive that thinks for longer than the timeout hears no stop meanwhile; then comes the stop's own transaction.
      constexpr double kTransaction_ms = 10.0;
      const double bound_ms =
          std::max(milliseconds_of(config.response_timeout), milliseconds_of(fault.step.delay) + kTransaction_ms);
      const double ratio = latency_ms / bound_ms;
      std::printf("stop: %s %-18s %.1f ms, %.2f of the bound\n", transport == Transport::kTcp ? "TCP" : "RTU",
                  fault.name, latency_ms, ratio);
      worst = std::max(worst, ratio);
    }
  }
  return worst;
}

// --- what the report finds ---

struct ReportFigures {
  double lead_amplitude = 0.0;  // relative errors
  double lead_phase_deg = 0.0;
  double alpha_z = 0.0;
  double reversal_um = 0.0;
  double drift = 0.0;
};

/// A linear scale, so that what the screw does can be seen; three leads of 100 um.
ReportFigures run_report() {
  sim::AxisParameters planted = good_axis();
  planted.feedback = sim::Feedback::kLinearScale;
  planted.lead_error_um = 0.4;
  planted.lead_um = 100.0;
  planted.lead_phase_deg = 35.0;
  planted.scale_error = 3e-4;
  planted.backlash_um = 0.35;
  planted.drift_um_per_min = 3.0;
  SimulatedDrive plant(kDriveCases[0], Transport::kTcp, planted);
  const auto stage = plant.open_homed();
  SystemClock clock;
  StageRunPlan plan;
  plan.from = Micrometers{0.0};
  plan.to = Micrometers{300.0};
  plan.steps = 50;
  plan.repeats = 4;
  plan.settle = kCriterion;
  plan.settle.window = Micrometers{5.0};  // the drive does not close its loop on the scale
  const auto points = run_stage(*stage, clock, plan, {}, {});
  StageReportOptions options;
  options.feedback = FeedbackSource::kLinearScale;
  options.step_quantum_um = 0.01;
  options.feedback_resolution_um = 0.01;
  options.lead_um = planted.lead_um;
  const StageReport report = make_stage_report(points, options);
  ReportFigures figures;
  const auto& fit = report.fit;
  figures.lead_amplitude = std::abs(fit->lead->amplitude_um.value / planted.lead_error_um - 1.0);
  figures.lead_phase_deg = std::abs(std::remainder(fit->lead->phase_deg - planted.lead_phase_deg, 360.0));
  figures.alpha_z = std::abs(fit->alpha_z->value - 1.0 - planted.scale_error);
  figures.reversal_um = std::abs(std::abs(fit->reversal_um->value) - planted.backlash_um);
  figures.drift = std::abs(fit->drift_um_per_min->value / planted.drift_um_per_min - 1.0);
  std::printf(
      "report: lead error %.4f um (planted %.4f) at %.1f deg (%.1f), alpha_z %.6f (%.6f), reversal %.3f um (%.3f), "
      "drift "
      "%.3f um/min (%.3f)\n",
      fit->lead->amplitude_um.value, planted.lead_error_um, fit->lead->phase_deg, planted.lead_phase_deg,
      fit->alpha_z->value, 1.0 + planted.scale_error, fit->reversal_um->value, planted.backlash_um,
      fit->drift_um_per_min->value, planted.drift_um_per_min);
  return figures;
}

double rounded(double value) { return std::round(value * 1e6) / 1e6; }

int run() {
  spdlog::set_level(spdlog::level::off);
  const StageFaultFigures faults = run_stage_faults();
  double sigma = 0.0;
  double bias = 0.0;
  double tcp_ms = 0.0;
  double rtu_ms = 0.0;
  for (const DriveCase& drive : kDriveCases) {
    for (const Transport transport : {Transport::kTcp, Transport::kRtu}) {
      const StepFigures steps = run_steps(drive, transport);
      sigma = std::max(sigma, steps.sigma_um);
      bias = std::max(bias, std::abs(steps.bias_um));
      double& slowest = transport == Transport::kTcp ? tcp_ms : rtu_ms;
      slowest = std::max(slowest, steps.step_ms);
    }
  }
  const double stop = run_stops();
  const ReportFigures report = run_report();
  const nlohmann::ordered_json json{{"wrong_values_accepted", faults.wrong_values},
                                    {"fault_cases", faults.cases},
                                    {"motions_too_many", faults.moves_too_many},
                                    {"step_sigma_um_max", rounded(sigma)},
                                    {"step_bias_um_max", rounded(bias)},
                                    {"tcp_step_over_ideal", rounded(tcp_ms / ideal_step_ms())},
                                    {"rtu_step_ms", rounded(rtu_ms)},
                                    {"stop_latency_over_timeout", rounded(stop)},
                                    {"lead_amplitude_error", rounded(report.lead_amplitude)},
                                    {"lead_phase_error_deg", rounded(report.lead_phase_deg)},
                                    {"alpha_z_error", rounded(report.alpha_z)},
                                    {"reversal_error_um", rounded(report.reversal_um)},
                                    {"drift_error", rounded(report.drift)}};
  std::cout << json.dump() << std::endl;
  return 0;
}

}  // namespace
}  // namespace fvd::test

int main() { return fvd::test::run(); }
