#pragma once

/// A groove with holes, and the result of measuring it.

#include <chrono>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "core/surface/surface.hpp"
#include "daemon/result/cross_section.hpp"
#include "daemon/result/result.hpp"

namespace fvd::test {

/// 120 um high, the groove 50 um deep and 30 % of the width wide; a hole of 10 x 6 points with two reasons, and single
/// outliers.
inline Surface groove_surface(int width = 160, int height = 120, double pitch_um = 2.0) {
  Surface surface;
  surface.height_m = Plane<float>(width, height);
  surface.sigma_m = Plane<float>(width, height, 0.2e-6F);
  surface.mask = Plane<MaskReasons>(width, height);
  surface.pitch_x_um = surface.pitch_y_um = pitch_um;
  surface.title = "part-42";
  const auto make_hole = [&surface](int x, int y, unsigned reasons) {
    if (x >= surface.width() || y >= surface.height()) return;
    surface.height_m.at(x, y) = surface.sigma_m.at(x, y) = std::numeric_limits<float>::quiet_NaN();
    surface.mask.at(x, y) = static_cast<MaskReasons>(reasons);
  };
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const double side = std::abs((x + 0.5) / width - 0.5);
      surface.height_m.at(x, y) = static_cast<float>((side < 0.15 ? 70.0 : 120.0) * 1e-6);
      surface.sigma_m.at(x, y) = static_cast<float>((0.2 + 0.3 * side) * 1e-6);
    }
  }
  for (int y = 10; y < 16; ++y) {
    for (int x = 5; x < 15; ++x) make_hole(x, y, mask_reason::kLowProminence | mask_reason::kSaturated);
  }
  for (int i = 0; i < 20; ++i) make_hole(100 + 2 * i, 30 + 3 * i, mask_reason::kOutlier);
  return surface;
}

inline EvaluatedValue value_of(double value, const std::string& unit, double expanded_u) {
  EvaluatedValue made;
  made.value = value;
  made.unit = unit;
  made.u = expanded_u / 2.0;
  made.expanded_u = expanded_u;
  made.k = 2.0;
  return made;
}

/// A step with limits, and areal values of which one is missing.
inline Evaluation sample_evaluation() {
  Evaluation evaluation;
  evaluation.verdict = Verdict::kPass;
  evaluation.rule = "iso14253_1";
  evaluation.order = {"step", "land"};
  evaluation.surfaces["texture"] =
      R"([{"op":"level","form":"plane","regions":["land"],"did":{"points_used":812,"points_removed":3}}])";
  EvaluatedMeasurement step;
  step.kind = "step_height";
  step.method = "iso5436_a1";
  step.surface = "measured";
  step.main_value = "height_um";
  step.points = 18230;
  step.valid_fraction = 0.998;
  EvaluatedValue height = value_of(49.98512, "um", 0.048);
  height.limits = Limits{49.5, 50.5};
  height.verdict = Verdict::kPass;
  step.values["height_um"] = height;
  step.values["height_areal_um"] = value_of(49.9913, "um", 0.04);
  step.verdict = Verdict::kPass;
  step.not_evaluated = {"temperature", "lateral"};
  step.cross_section = CrossSection{0.0, 120.0, 320.0, 120.0, 200.0, {{"A", 16.0, 96.0}, {"C", 144.0, 176.0}}};
  evaluation.measurements["step"] = std::move(step);
  EvaluatedMeasurement land;
  land.kind = "areal";
  land.surface = "texture";
  land.region = "land";
  land.main_value = "Sa_um";
  land.points = 5000;
  land.valid_fraction = 1.0;
  land.details = R"({"noise_floor_Sq_um":0.21,"window_um":9.0})";
  land.values["Sa_um"] = value_of(0.412, "um", 0.03);
  land.values["Str"].unit = "1";
  land.values["Str"].reason = "the autocorrelation does not fall to the threshold";
  evaluation.measurements["land"] = std::move(land);
  return evaluation;
}

inline Result sample_report_result() {
  Result result;
  result.job = {"J7", 4711, "part-42"};
  result.recipe = {"groove", "0123456789abcdef0123456789abcdef"};
  result.provenance = {"1.2.3", true,
                       std::chrono::system_clock::time_point(std::chrono::milliseconds(1'700'000'000'123)),
                       "camera and stage"};
  result.points = 160U * 120U;
  result.valid_points = result.points - 80U;
  result.focus.width_px = 160;
  result.focus.height_px = 120;
  result.focus.pixel_pitch_x_um = result.focus.pixel_pitch_y_um = 2.0;
  result.evaluation = sample_evaluation();
  result.verdict = Verdict::kPass;
  result.warnings = {{"light_flicker", "the light varies by 3 %"}};
  return result;
}

}  // namespace fvd::test
