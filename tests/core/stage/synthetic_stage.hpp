#pragma once

/// A stage whose faults are known, run up and down over its range.

#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <random>
#include <vector>

#include "core/stage/stage_point.hpp"

namespace fvd::test {

struct SyntheticStage {
  double alpha_z = 1.0004;
  double offset_um = 0.7;
  double lead_um = 1000.0;
  double amplitude_um = 0.3;
  double phase_deg = 40.0;
  double reversal_um = 0.8;
  double drift_um_per_min = 0.25;
  double drift_um_per_k = 0.0;
  double noise_um = 0.02;
  double quantum_um = 0.01;
  std::function<double(double)> temperature_c;  ///< of the time in s; none = unknown

  double start_um = 120.0;
  double range_um = 3000.0;
  int positions = 61;
  int runs = 3;
  bool up = true;
  bool down = true;
  double seconds_per_point = 0.8;
  unsigned seed = 1;
};

inline std::vector<StagePoint> synthetic_points(const SyntheticStage& stage) {
  std::mt19937 generator(stage.seed);
  std::normal_distribution<double> noise(0.0, stage.noise_um);
  std::vector<StagePoint> points;
  double time_s = 0.0;
  const auto visit = [&](int run, int direction, int place) {
    StagePoint p;
    p.time_s = time_s;
    p.run = run;
    p.direction = direction;
    p.commanded_um = stage.start_um + stage.range_um * place / std::max(1, stage.positions - 1);
    p.quantised_um = std::round(p.commanded_um / stage.quantum_um) * stage.quantum_um;
    const double z = p.quantised_um;
    p.measured_um = stage.offset_um + stage.alpha_z * z + stage.reversal_um * direction / 2 +
                    stage.amplitude_um * std::sin(2 * std::numbers::pi * z / stage.lead_um +
                                                  stage.phase_deg * std::numbers::pi / 180.0) +
                    stage.drift_um_per_min * time_s / 60.0 + noise(generator);
    if (stage.temperature_c) {
      p.temperature_c = stage.temperature_c(time_s);
      p.measured_um += stage.drift_um_per_k * (*p.temperature_c - 20.0);
    }
    p.settle_ms = 20.0 + place % 10;
    p.move_ms = 60.0 + place % 10;
    p.polls = 5;
    points.push_back(p);
    time_s += stage.seconds_per_point;
  };
  for (int run = 0; run < stage.runs; ++run) {
    if (stage.up) {
      for (int i = 0; i < stage.positions; ++i) visit(run, 1, i);
    }
    if (stage.down) {
      for (int i = stage.positions - 1; i >= 0; --i) visit(run, -1, i);
    }
  }
  return points;
}

inline StageReportOptions scale_options() { return {FeedbackSource::kLinearScale, 0.01, 0.005, 1000.0}; }

}  // namespace fvd::test
