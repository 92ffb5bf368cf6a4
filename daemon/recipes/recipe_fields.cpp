/// The keys of a recipe: names, ranges, meanings.

#include <algorithm>
#include <chrono>

#include "config/field_writer.hpp"
#include "daemon/evaluation/evaluation_fields.hpp"
#include "daemon/export/exporter_table.hpp"
#include "daemon/recipes/recipe_document.hpp"

namespace fvd {

namespace {

constexpr int kMaxSidePx = 65535;

void describe_format(Fields& fields, CameraSettings& camera) {
  std::vector<std::string> names;
  for (const SensorFormat format : kAllSensorFormats) names.emplace_back(sensor_format_info(format).name);
  std::string name(sensor_format_info(camera.pixel_format).name);
  fields.choice("pixel_format", name, names, "PixelFormat by its GenICam name");
  for (const SensorFormat format : kAllSensorFormats) {
    if (name == sensor_format_info(format).name) camera.pixel_format = format;
  }
  fields.integer("significant_bits", camera.significant_bits, {0, 12},
                 "of a camera whose Mono16 has its values at the upper end: 10 or 12; 0 = 16");
  std::string bayer = camera.bayer == BayerUse::kGreen ? "green" : "luminance";
  fields.choice("bayer", bayer, {"green", "luminance"}, "what of a colour mosaic is measured");
  camera.bayer = bayer == "green" ? BayerUse::kGreen : BayerUse::kLuminance;
}

std::vector<std::string> peak_names() {
  std::vector<std::string> names;
  for (const PeakMethod method : kAllPeakMethods) names.emplace_back(peak_method_name(method));
  return names;
}

void describe_settle(SettleCriterion& settle, Fields& fields) {
  fields.number("window_um", settle.window.value, positive(1000.0), "largest |measured - target| of an arrived stage");
  fields.integer("samples", settle.samples, {1, 1000}, "consecutive samples inside the window");
  auto dwell_ms = settle.dwell.count();
  fields.integer("dwell_ms", dwell_ms, {0, 10000}, "time those samples span at least");
  settle.dwell = std::chrono::milliseconds(dwell_ms);
  auto timeout_ms = settle.timeout.count();
  fields.integer("timeout_ms", timeout_ms, {10, 600000}, "from the start of the move; later fails the job");
  settle.timeout = std::chrono::milliseconds(timeout_ms);
}

void describe_scan(Recipe& recipe, Fields& fields) {
  fields.number("start_um", recipe.start_um, {-1e6, 1e6}, "z of the lowest slice");
  fields.require("start_um");
  fields.number("step_um", recipe.step_um, positive(1e5), "distance of slices");
  fields.require("step_um");
  fields.integer("slices", recipe.slices, {3, 65535}, "number of slices");
  fields.require("slices");
  std::string mode = recipe.mode == ScanMode::kContinuous ? "continuous" : "step";
  fields.choice("mode", mode, {"step", "continuous"},
                "step = the stage stops for every slice; continuous = it does not");
  recipe.mode = mode == "continuous" ? ScanMode::kContinuous : ScanMode::kStep;
  std::string direction = recipe.downwards ? "down" : "up";
  fields.choice("direction", direction, {"up", "down"},
                "step: up = from start_um upwards; down = the same slices from the highest on, approached from above");
  recipe.downwards = direction == "down";
  fields.number("speed_um_per_s", recipe.speed_um_per_s, {0.0, 1e6}, "continuous: speed of the stage");
  fields.number("max_blur_steps", recipe.max_blur_steps, positive(10.0),
                "continuous: way of the stage during an exposure, in steps; more is refused");
  std::string trigger = recipe.camera.trigger == TriggerMode::kLine ? "line" : "software";
  fields.choice("trigger", trigger, {"software", "line"},
                "step: software, or the camera's line that the drive's in-position output is wired to");
  recipe.camera.trigger = trigger == "line" ? TriggerMode::kLine : TriggerMode::kSoftware;
  fields.text("trigger_line", recipe.camera.trigger_line, 64, "TriggerSource of that line");
  fields.integer("frame_retries", recipe.frame_retries, {0, 100}, "further triggers for a slice whose frame was lost");
  fields.integer("allowed_lost_slices", recipe.allowed_lost_slices, {0, 65532}, "more fail the job");
  fields.relate("allowed_lost_slices", recipe.allowed_lost_slices, Relation::kAtMost, "slices", recipe.slices, -3);
  fields.group("settle", "when the stage counts as arrived", [&](Fields& in) { describe_settle(recipe.settle, in); });
}

void describe_camera(CameraSettings& camera, Fields& fields) {
  describe_format(fields, camera);
  fields.integer("width_px", camera.width, {0, kMaxSidePx}, "0 = all the sensor has");
  fields.integer("height_px", camera.height, {0, kMaxSidePx}, "0 = all the sensor has");
  fields.integer("offset_x_px", camera.offset_x, {0, kMaxSidePx}, "left edge of the region");
  fields.integer("offset_y_px", camera.offset_y, {0, kMaxSidePx}, "upper edge of the region");
  fields.number("exposure_us", camera.exposure_us, positive(6e7), "ExposureTime");
  fields.number("gain_db", camera.gain_db, {0.0, 100.0}, "Gain");
  fields.integer("gain_raw", camera.gain_raw, {-1, 1'000'000},
                 "GainRaw of cameras without a Gain in dB, in a unit of their own; -1 = the least");
}

void describe_drift(Recipe& recipe, Fields& fields) {
  fields.number(
      "drift_px_per_um_x", recipe.drift_px_per_um_x, {-10.0, 10.0},
      "the image moves right by so many pixels while z rises by 1 um; every slice is put back by whole pixels");
  fields.number("drift_px_per_um_y", recipe.drift_px_per_um_y, {-10.0, 10.0}, "the same downwards");
}

void describe_focus(Recipe& recipe, Fields& fields) {
  std::vector<std::string> operators;
  for (const FocusOperator op : kAllFocusOperators) operators.emplace_back(focus_operator_name(op));
  std::string op(focus_operator_name(recipe.focus.focus_operator));
  fields.choice("operator", op, operators, "what is summed over the window as the measure of sharpness");
  recipe.focus.focus_operator = focus_operator_from_name(op).value_or(recipe.focus.focus_operator);
  std::vector<std::string> windows;
  for (const FocusWindow window : kAllFocusWindows) windows.emplace_back(focus_window_name(window));
  std::string window(focus_window_name(recipe.focus.window));
  fields.choice("window", window, windows,
                "weights of the window: box = all alike, double_box = falling to the rim, two boxes over each other");
  recipe.focus.window = focus_window_from_name(window).value_or(recipe.focus.window);
  if (has_point_window(recipe.focus.focus_operator)) recipe.focus.window_px = 1;
  fields.integer("window_px", recipe.focus.window_px, {1, kMaxWindowPx},
                 "side of the square window, odd, 3 and more; of a double box the box that spreads as far; of the "
                 "intensity 1 by default");
  fields.integer("distance_px", recipe.focus.distance_px, {1, kMaxDistancePx},
                 "from a pixel to the neighbours that its operator looks at");
  fields.number("curve_width_um", recipe.curve_width_um, {0.0, 1e5},
                "full width at half maximum of the focus curve; 0 = as the recipe's last good scans told it");
  fields.integer("bin_slices", recipe.bin_slices, {0, kMaxBinSlices},
                 "slices summed to one sample of the curve; 0 = by the curve's width, 1 where that is unknown");
  std::string peak(peak_method_name(recipe.peak));
  fields.choice("peak", peak, peak_names(), "how a height is taken from the samples around the sharpest");
  recipe.peak = peak_method_from_name(peak).value_or(recipe.peak);
  std::vector<std::string> extra;
  for (const PeakMethod method : recipe.extra_peaks) extra.emplace_back(peak_method_name(method));
  fields.choices("extra_peaks", extra, peak_names(), "further height maps of the same scan");
  recipe.extra_peaks.clear();
  for (const std::string& name : extra) recipe.extra_peaks.push_back(peak_method_from_name(name).value());
  fields.number("min_prominence", recipe.focus.min_prominence, {0.0, 1.0},
                "(peak - minimum) / peak of the focus curve; below it a point is a hole");
  fields.number("min_significance", recipe.focus.min_significance, {0.0, 1e6},
                "(peak - minimum) / noise of a sample; below it a point is a hole");
  fields.boolean("stage_correction", recipe.focus.stage_correction,
                 "seek the stage's errors in the focus curves and correct heights by them where the surface lets it");
}

void describe_tests(PointTests& tests, Fields& fields) {
  fields.number("broad_curve", tests.broad_curve, {0.0, 1.0},
                "bend of a point's focus curve over the scan's median; below it the point is a hole; 0 = no such test");
  fields.number(
      "narrow_curve", tests.narrow_curve, {0.0, 1.0},
      "width of a point's focus curve over the scan's median; below it the point is a hole; 0 = no such test");
  fields.number(
      "second_peak", tests.second_peak, {0.0, 1.0},
      "height of a focus curve's second peak, at least four samples away and beyond a valley, over that of "
      "the first; above it the point is a hole; 0.8 is usual, 0.5 the least; takes 2 bytes more per pixel; 0 = "
      "no such test");
  fields.number(
      "clipped_share", tests.clipped_share, {0.0, 1.0},
      "share of the window's pixels at full scale at the peak; if more are, or noticeably more beside the peak "
      "than at it, the point is a hole; 0 = no such test");
  fields.integer(
      "edge_band_slices", tests.edge_band_slices, {0, kMaxEdgeBandSlices},
      "where heights two pixels apart differ by more, and by more than a focus curve's width, the points on the "
      "sharper side to which its window reaches across are holes; 0 = no such test");
  fields.number("max_sigma_um", tests.max_sigma_um, {0.0, kMaxSigmaLimit_um},
                "standard error of a height above which the point is a hole; 0 = no such test");
}

void describe_lateral(Recipe& recipe, Fields& fields) {
  fields.number("pixel_pitch_x_um", recipe.pixel_pitch_x_um, positive(1e5), "distance of columns on the object");
  fields.number("pixel_pitch_y_um", recipe.pixel_pitch_y_um, positive(1e5), "distance of rows on the object");
}

void describe_description(Recipe& recipe, Fields& fields) {
  fields.text("description", recipe.description, 1000, "for people");
}

void describe_acquisition(Recipe& recipe, Fields& fields) {
  fields.group("scan", "where the slices lie", [&](Fields& in) { describe_scan(recipe, in); });
  fields.require("scan");
  fields.group("camera", "settings of the camera", [&](Fields& in) {
    describe_camera(recipe.camera, in);
    describe_drift(recipe, in);
  });
}

void describe_heights(Recipe& recipe, Fields& fields) {
  fields.group("focus", "from slices to heights", [&](Fields& in) { describe_focus(recipe, in); });
  fields.group("holes", "which points must be holes", [&](Fields& in) { describe_tests(recipe.focus.tests, in); });
  fields.group("lateral", "scale on the object", [&](Fields& in) { describe_lateral(recipe, in); });
}

void describe_min_valid_fraction(Recipe& recipe, Fields& fields) {
  fields.number("min_valid_fraction", recipe.min_valid_fraction, {0.0, 1.0}, "fewer valid points fail the job");
}

void describe_slices_kept(std::string_view key, Recipe& recipe, Fields& fields) {
  fields.boolean(key, recipe.keep_slices, "also keep the slices, in the result's folder slices/");
}

std::vector<std::string> exporter_names() {
  std::vector<std::string> names;
  for (const Exporter& exporter : exporter_table()) names.emplace_back(exporter.name);
  for (const Exporter& exporter : exporter_table()) {
    const bool is_new = std::find(names.begin(), names.end(), exporter.format) == names.end();
    if (!exporter.format.empty() && is_new) names.emplace_back(exporter.format);
  }
  return names;
}

}  // namespace

void describe(Recipe& recipe, Fields& fields) {
  std::int64_t format = kRecipeFormat;
  fields.integer64("format", format, {kRecipeFormat, kRecipeFormat}, "of this document");
  fields.require("format");
  describe_description(recipe, fields);
  fields.group("acquire", "how the slices are taken", [&](Fields& in) {
    describe_acquisition(recipe, in);
    in.text("objective", recipe.objective, 64, "name of the objective that must be the confirmed one; empty = any");
    in.integer("repeat", recipe.repeat, {1, 20},
               "scans of the job; the heights are their mean, points that one lacks are holes");
  });
  fields.require("acquire");
  fields.group("reconstruct", "how heights are made of them", [&](Fields& in) {
    describe_heights(recipe, in);
    in.optional("smooth_px", recipe.smooth_px, [](Fields& inner, double& value) {
      inner.number("smooth_px", value, {kMinSmoothPx, kMaxSmoothPx},
                   "also a smoothed map: a quadratic through the heights about each point, weights of this standard "
                   "deviation; absent = none");
    });
    describe_min_valid_fraction(recipe, in);
  });
  fields.group("evaluation", "what is measured on the heights, and how it is judged",
               [&](Fields& in) { describe(recipe.evaluation, in); });
  fields.optional("export", recipe.exports, [](Fields& in, std::vector<std::string>& names) {
    in.choices("export", names, exporter_names(),
               "files of a result beside result.json, by name or format; absent = all but height.x3p, .sdf, .ply, "
               ".stl, .csv, sigma.gsf, repeat_sd.gsf, report.pdf and the pictures sigma.png, holes.png and view3d.png");
  });
  fields.group("report", "for people", [&](Fields& in) {
    in.optional("pdf", recipe.report.pdf, [](Fields& inner, bool& pdf) {
      inner.boolean("pdf", pdf, "with report.pdf, or without it, whatever export says; absent = as export says");
    });
    in.choice("language", recipe.report.language, {"en"}, "of the report");
  });
  fields.group("keep", "what else is kept", [&](Fields& in) { describe_slices_kept("slices", recipe, in); });
}

void describe_format_1(Recipe& recipe, Fields& fields) {
  describe_description(recipe, fields);
  describe_acquisition(recipe, fields);
  describe_heights(recipe, fields);
  fields.group("result", "what is kept and what is good enough", [&](Fields& in) {
    describe_min_valid_fraction(recipe, in);
    describe_slices_kept("record_slices", recipe, in);
  });
}

std::string recipe_schema_text() {
  Recipe defaults;
  return fields_to_schema([&](Fields& fields) { describe(defaults, fields); }, "fvd recipe").dump(2) + "\n";
}

}  // namespace fvd
