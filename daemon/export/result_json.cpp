#include "daemon/export/result_json.hpp"

#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "config/field_writer.hpp"
#include "daemon/export/json_values.hpp"

namespace fvd {

namespace {

using Json = nlohmann::ordered_json;

Json um(double value) { return rounded(value, 4); }
Json ms(double value) { return rounded(value, 3); }

Json um_or_null(const std::optional<double>& value) { return value ? um(*value) : Json(nullptr); }
Json number_or_null(const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); }

/// Of format 1, for its readers: the same heights by other names.
Json height_values(const std::optional<double>& min, const std::optional<double>& max,
                   const std::optional<double>& mean, const std::optional<double>& median) {
  return {{"min_um", um_or_null(min)},
          {"max_um", um_or_null(max)},
          {"mean_um", um_or_null(mean)},
          {"median_um", um_or_null(median)}};
}

std::optional<double> value_of(const Result& result, std::string_view name) {
  const MeasuredValue* const measured = result.find(name);
  return measured == nullptr ? std::nullopt : measured->value;
}

Json measurement(const MeasuredValue& measured) {
  const int decimals = measured.unit == "um" ? 4 : 6;
  Json json{{"kind", measured.kind}, {"value", rounded(measured.value, decimals)}, {"unit", measured.unit}};
  if (measured.u) json["u"] = *measured.u;
  if (measured.expanded_u) json["U"] = *measured.expanded_u;
  if (measured.k) json["k"] = *measured.k;
  json["points"] = measured.points;
  json["valid_fraction"] = rounded(measured.valid_fraction, 6);
  if (measured.limits) {
    json["limits"] = {{"lower", number_or_null(measured.limits->lower)},
                      {"upper", number_or_null(measured.limits->upper)}};
  }
  if (measured.verdict) json["verdict"] = verdict_name(*measured.verdict);
  return json;
}

Json measurements(const std::vector<MeasuredValue>& values) {
  Json json = Json::object();
  for (const MeasuredValue& value : values) json[value.name] = measurement(value);
  return json;
}

Json warnings(const std::vector<Warning>& warnings) {
  Json list = Json::array();
  for (const Warning& warning : warnings) list.push_back({{"code", warning.code}, {"text", warning.text}});
  return list;
}

Json holes(const HoleCounts& counts) {
  return {{"low_prominence", counts.low_prominence}, {"first_slice", counts.first_slice},
          {"last_slice", counts.last_slice},         {"not_bracketed", counts.not_bracketed},
          {"saturated", counts.saturated},           {"insignificant", counts.insignificant},
          {"edge_bleeding", counts.edge_bleeding},   {"broad_curve", counts.broad_curve},
          {"narrow_curve", counts.narrow_curve},     {"second_peak", counts.second_peak},
          {"edge_band", counts.edge_band},           {"max_sigma", counts.max_sigma},
          {"out_of_view", counts.out_of_view}};
}

Json values(const Result& result) {
  return {{"height", height_values(value_of(result, "height_min"), value_of(result, "height_max"),
                                   value_of(result, "height_mean"), value_of(result, "height_median"))},
          {"points", result.points},
          {"valid_points", result.valid_points},
          {"valid_fraction", rounded(result.valid_fraction(), 6)},
          {"hole_points", holes(result.holes)},
          {"sigma_median_um", um_or_null(value_of(result, "sigma_median"))}};
}

Json point_tests(const PointTests& tests) {
  return {{"broad_curve", tests.broad_curve},           {"narrow_curve", tests.narrow_curve},
          {"second_peak", tests.second_peak},           {"clipped_share", tests.clipped_share},
          {"edge_band_slices", tests.edge_band_slices}, {"max_sigma_um", tests.max_sigma_um}};
}

Json focus(const Result::Focus& focus) {
  Json json;
  json["width_px"] = focus.width_px;
  json["height_px"] = focus.height_px;
  json["pixel_pitch_x_um"] = number_or_null(focus.pixel_pitch_x_um);
  json["pixel_pitch_y_um"] = number_or_null(focus.pixel_pitch_y_um);
  json["operator"] = focus_operator_name(focus.settings.focus_operator);
  json["window"] = focus_window_name(focus.settings.window);
  json["window_px"] = focus.settings.window_px;
  json["smooth_px"] = focus.smooth_px ? Json(*focus.smooth_px) : Json(nullptr);
  json["lateral_period_px"] = rounded(focus.lateral_period_px, 2);
  json["smooth_lateral_period_px"] =
      focus.smooth_lateral_period_px ? Json(rounded(*focus.smooth_lateral_period_px, 2)) : Json(nullptr);
  json["distance_px"] = focus.settings.distance_px;
  json["min_prominence"] = focus.settings.min_prominence;
  json["min_significance"] = focus.settings.min_significance;
  json["bin_slices"] = focus.settings.bin_slices;
  json["bins_by"] = bin_choice_name(focus.bins_by);
  json["holes"] = point_tests(focus.settings.tests);
  json["noise_grey"] = rounded(focus.noise_grey, 3);
  json["curve_width_um"] = um_or_null(focus.curve_width_um);
  json["peak"] = peak_method_name(focus.peak);
  Json extra = Json::array();
  for (const FurtherHeights& further : focus.extra_peaks) {
    extra.push_back({{"peak", peak_method_name(further.peak)},
                     {"height", height_values(further.min_um, further.max_um, further.mean_um, further.median_um)}});
  }
  json["extra_peaks"] = std::move(extra);
  json["state_bytes_per_pixel"] = rounded(focus.state_bytes_per_pixel, 3);
  if (focus.texture_max_grey) json["texture_max_grey"] = *focus.texture_max_grey;
  return json;
}

Json frames(const FrameCounts& counts) {
  return {{"expected", counts.expected}, {"ok", counts.ok},       {"incomplete", counts.incomplete},
          {"missing", counts.missing},   {"stale", counts.stale}, {"underrun", counts.underrun}};
}

Json suspects(const std::vector<SuspectSlice>& slices) {
  Json list = Json::array();
  for (const SuspectSlice& slice : slices) {
    list.push_back({{"index", slice.index},
                    {"z_um", um(slice.z_um)},
                    {"reason", suspect_reason_name(slice.reason)},
                    {"figure", rounded(slice.figure, 4)},
                    {"figure_is", suspect_figure_text(slice.reason)},
                    {"unit", "1"},
                    {"done", suspect_done_name(slice.done)}});
    if (!slice.file.empty()) list.back()["file"] = slice.file;
  }
  return list;
}

Json drift(const Result::Drift& drift) {
  return {{"x", rounded(drift.x_px, 3)},
          {"y", rounded(drift.y_px, 3)},
          {"x_per_um", rounded(drift.x_px_per_um, 6)},
          {"y_per_um", rounded(drift.y_px_per_um, 6)},
          {"undone", drift_undone_name(drift.undone)}};
}

Json slices(const Result::Slices& slices) {
  Json json{{"planned", slices.planned},
            {"measured", slices.measured},
            {"first_um", um_or_null(slices.first_um)},
            {"last_um", um_or_null(slices.last_um)}};
  if (slices.exposure_us) json["exposure_us"] = rounded(*slices.exposure_us, 3);
  json["scan_mode"] = slices.mode == ScanMode::kContinuous ? "continuous" : "step";
  if (slices.mode == ScanMode::kContinuous) {
    json["speed_um_per_s"] = um(slices.speed_um_per_s);
    json["ramp_frames"] = slices.ramp_frames;
  }
  json["suspect"] = suspects(slices.suspect);
  json["retaken"] = slices.retaken;
  json["flicker_percent"] = slices.flicker_percent ? rounded(*slices.flicker_percent, 3) : Json(nullptr);
  json["drift_px"] = slices.drift ? drift(*slices.drift) : Json(nullptr);
  json["scale_percent"] = slices.scale_percent ? rounded(*slices.scale_percent, 4) : Json(nullptr);
  return json;
}

Json steps(const StepSummary& summary) {
  return {{"steps", summary.steps},
          {"error_mean_um", um(summary.error_mean_um)},
          {"error_sd_um", um(summary.error_sd_um)},
          {"error_max_um", um(summary.error_max_um)},
          {"increment_error_sd_um", um(summary.increment_error_sd_um)},
          {"increment_error_max_um", um(summary.increment_error_max_um)},
          {"move_median_ms", ms(summary.move_median_ms)},
          {"move_max_ms", ms(summary.move_max_ms)}};
}

/// With the resolution of the positions, which their uncertainty needs.
Json steps(const Result& result) {
  Json json = steps(result.steps);
  if (result.encoder_resolution_um) json["encoder_resolution_um"] = *result.encoder_resolution_um;
  return json;
}

Json stage(const Result::Stage& stage) {
  return {{"corrected", stage.corrected},
          {"reason", text_or_null(stage.reason)},
          {"offsets_rms_um", um(stage.offsets_rms_um)},
          {"offset_error_um", um(stage.offset_error_um)}};
}

Json times(const PhaseTimes& times) {
  return {{"prepare_ms", ms(times.prepare_ms)},
          {"scan_ms", ms(times.scan_ms)},
          {"finish_ms", ms(times.finish_ms)},
          {"write_ms", ms(times.write_ms)}};
}

Json times(const Result& result) {
  Json json = times(result.times);
  if (result.times.evaluate_ms) json["evaluate_ms"] = ms(*result.times.evaluate_ms);
  if (result.times.follow_ms) json["follow_ms"] = ms(*result.times.follow_ms);
  return json;
}

/// The recipe stands here for readers of format 1.
Json provenance(const Result& result) {
  return {{"recipe", text_or_null(result.recipe.id)},
          {"recipe_sha256", text_or_null(result.recipe.sha256)},
          {"software_version", text_or_null(result.provenance.software_version)},
          {"simulated", result.provenance.simulated},
          {"created", iso8601_utc(result.provenance.created)},
          {"source", text_or_null(result.provenance.source)}};
}

Json file_list(const std::vector<ResultFile>& files) {
  Json list = Json::array();
  for (const ResultFile& file : files) {
    Json entry{{"name", file.name}};
    if (file.files) {
      entry["files"] = *file.files;
    } else {
      entry["state"] = file_state_name(file.state);
    }
    if (file.state == FileState::kWritten) entry["size_bytes"] = file.size_bytes;
    if (!file.sha256.empty()) entry["sha256"] = file.sha256;
    if (!file.reason.empty()) entry["reason"] = file.reason;
    list.push_back(std::move(entry));
  }
  return list;
}

Json temperature(const Temperature& measured) {
  return {{"celsius", measured.celsius}, {"source", measured.source}, {"age_s", measured.age_s}};
}

/// What the evaluation knew beside the surface, with every digit: it is evaluated again with these.
void add_conditions(const Result& result, Json& json) {
  json["objective"] = text_or_null(result.objective);
  json["temperature"] = result.temperature ? temperature(*result.temperature) : Json(nullptr);
  json["calibration"] = nullptr;
  if (result.calibration) {
    Calibration calibration = *result.calibration;
    json["calibration"] = fields_to_json([&](Fields& fields) { describe(calibration, fields); });
  }
  json["repeatability"] = Json::object();
  for (const auto& [name, found] : result.repeatability) {
    Repeatability repeatability = found;
    json["repeatability"][name] = fields_to_json([&](Fields& fields) { describe(repeatability, fields); });
  }
}

std::string text_of(const Json& json) { return json.dump(2, ' ', true, Json::error_handler_t::replace) + "\n"; }

}  // namespace

std::string result_json_with_files(std::string_view text, const std::vector<ResultFile>& files, double follow_ms) {
  Json json = Json::parse(text);
  json.at("files") = file_list(files);
  json.at("times")["follow_ms"] = ms(follow_ms);
  return text_of(json);
}

std::string result_json_text(const Result& result) {
  Json json;
  json["format"] = Result::kFormat;
  json["job"] = {{"job_id", text_or_null(result.job.id)},
                 {"seq", result.job.seq ? Json(*result.job.seq) : Json(nullptr)},
                 {"part_id", text_or_null(result.job.part_id)},
                 {"recipe", text_or_null(result.recipe.id)}};
  json["recipe"] = {{"id", text_or_null(result.recipe.id)}, {"sha256", text_or_null(result.recipe.sha256)}};
  add_conditions(result, json);
  json["verdict"] = result.verdict ? Json(verdict_name(*result.verdict)) : Json(nullptr);
  json["measurements"] = measurements(result.measurements);
  if (result.evaluation) {
    Evaluation evaluation = *result.evaluation;
    json["evaluation"] = fields_to_json([&](Fields& fields) { describe(evaluation, fields); });
  }
  json["warnings"] = warnings(result.warnings);
  json["values"] = values(result);
  json["focus"] = focus(result.focus);
  json["frames"] = frames(result.frames);
  json["slices"] = slices(result.slices);
  if (result.repeat) {
    json["repeat"] = {{"scans", result.repeat->scans}, {"sd_rms_um", um_or_null(result.repeat->sd_rms_um)}};
  }
  json["steps"] = steps(result);
  json["stage_in_curves"] = stage(result.stage);
  json["times"] = times(result);
  json["provenance"] = provenance(result);
  json["files"] = file_list(result.files);
  return text_of(json);
}

}  // namespace fvd
