#pragma once

/// A small result with one hole of every kind.

#include <cmath>
#include <limits>

#include "core/base/units.hpp"
#include "core/surface/mask_reason.hpp"
#include "core/surface/statistics.hpp"
#include "daemon/result/result_data.hpp"

namespace fvd::test {

/// height[y][x] = x + 10 y um; the points of `hole` in the first row carry one reason each.
inline HeightMap sample_map(int width = 6, int height = 3) {
  HeightMap map = empty_map(width, height, PixelFormat::kMono8);
  map.mask = Plane<MaskReasons>(width, height);
  map.prominence = Plane<float>(width, height, 0.9F);
  map.sigma_m = Plane<float>(width, height, 0.2e-6F);
  map.noise_grey = 1.5;
  map.curve_width_um = 30.0;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      map.height_m.at(x, y) = static_cast<float>((x + 10 * y) * kMetresPerMicrometer);
      map.texture.at(x, y) = static_cast<std::uint16_t>(x + 10 * y);
    }
  }
  return map;
}

inline void make_hole(HeightMap& map, int x, int y, unsigned reasons) {
  map.mask.at(x, y) = static_cast<MaskReasons>(reasons);
  map.height_m.at(x, y) = std::numeric_limits<float>::quiet_NaN();
  map.sigma_m.at(x, y) = std::numeric_limits<float>::quiet_NaN();
}

inline HeightSummary summary_of(const HeightMap& map) { return summarize_heights(map.height_m, map.sigma_m, map.mask); }

inline ResultData sample_result() {
  ResultData data;
  data.software_version = "1.2.3";
  data.created = std::chrono::system_clock::time_point(std::chrono::milliseconds(1'700'000'000'123));
  data.simulated = true;
  data.job_id = "J7";
  data.seq = 4711;
  data.part_id = "part-42";
  data.recipe_id = "chapter";
  data.recipe_sha256 = "abc";
  data.source = "camera and stage";
  data.peak = PeakMethod::kLogParabola;
  data.pixel_pitch_x_um = 2.0;
  data.pixel_pitch_y_um = 4.0;
  data.state_bytes_per_pixel = 24.0;
  data.map = sample_map();
  make_hole(data.map, 0, 0, mask_reason::kLowProminence);
  make_hole(data.map, 1, 0, mask_reason::kFirstSlice | mask_reason::kSaturated);
  data.slices_planned = 3;
  data.frames = {4, 3, 1, 0, 0, 0};
  for (int i = 0; i < 3; ++i) {
    StepRecord step;
    step.index = i;
    step.commanded_um = 10.0 * i;
    step.quantised_um = 10.0 * i;
    step.commanded_counts = 1000 * i;
    step.measured_um = 10.0 * i + 0.0625;
    step.error_um = 0.0625;
    step.move_ms = 12.5;
    step.settle_polls = 4;
    step.position_samples = 2;
    step.frame_id = static_cast<std::uint64_t>(i) + 7;
    step.exposure_start = HostTime(std::chrono::milliseconds(500 + 20 * i));
    data.steps.push_back(step);
  }
  data.steps[1].measured = false;
  data.steps[1].triggers = 4;
  data.step_summary = {2, 0.0625, 0.0, 0.0625, 0.0, 0.0, 12.5, 12.5};
  data.times = {100.0, 2000.0, 5.0, 0.0};
  return data;
}

/// A step with a cross section, and a cutting edge of three sections, the middle one not measured, with a notch.
inline Evaluation sample_measurements() {
  Evaluation evaluation;
  evaluation.order = {"step", "edge"};
  EvaluatedMeasurement step;
  step.kind = "step_height";
  step.main_value = "height_um";
  step.values["height_um"].value = 49.98;
  step.values["height_um"].unit = "um";
  step.cross_section = CrossSection{0.0, 6.0, 12.0, 6.0, 4.0, {{"A", 2.0, 4.0}}};
  evaluation.measurements["step"] = step;
  EvaluatedMeasurement edge;
  edge.kind = "cutting_edge";
  edge.main_value = "radius_um";
  edge.values["radius_um"].value = 10.0;
  edge.values["radius_um"].unit = "um";
  edge.values["notches"].value = 1.0;
  edge.details =
      R"({"sections":[{"along_um":0,"radius_um":10},{"along_um":10,"unmeasured":"hole"},{"along_um":20,"radius_um":11}],)"
      R"("chipping":{"notches":[{"along_um":18,"depth_um":4,"width_um":3}]}})";
  evaluation.measurements["edge"] = edge;
  return evaluation;
}

}  // namespace fvd::test
