#include "daemon/export/result_json.hpp"

#include <map>

#include <nlohmann/json.hpp>

#include "daemon/export/json_values.hpp"

namespace fvd {

namespace {

using Json = nlohmann::ordered_json;

Json um(double value) { return rounded(value, 4); }
Json ms(double value) { return rounded(value, 3); }

Json height_values(const HeightSummary& summary) {
  Json json;
  const auto& height = summary.height;
  json["min_um"] = height ? um(height->min_um) : Json(nullptr);
  json["max_um"] = height ? um(height->max_um) : Json(nullptr);
  json["mean_um"] = height ? um(height->mean_um) : Json(nullptr);
  json["median_um"] = height ? um(height->median_um) : Json(nullptr);
  return json;
}

Json holes(const HoleCounts& counts) {
  return {{"low_prominence", counts.low_prominence}, {"first_slice", counts.first_slice},
          {"last_slice", counts.last_slice},         {"not_bracketed", counts.not_bracketed},
          {"saturated", counts.saturated},           {"insignificant", counts.insignificant},
          {"edge_bleeding", counts.edge_bleeding}};
}

Json values(const HeightSummary& summary) {
  Json json;
  json["height"] = height_values(summary);
  json["points"] = summary.points;
  json["valid_points"] = summary.valid;
  json["valid_fraction"] = rounded(summary.valid_fraction(), 6);
  json["hole_points"] = holes(summary.holes);
  json["sigma_median_um"] = summary.sigma_median_um ? um(*summary.sigma_median_um) : Json(nullptr);
  return json;
}

Json focus(const ResultData& data) {
  Json json;
  json["width_px"] = data.map.height_m.width();
  json["height_px"] = data.map.height_m.height();
  json["pixel_pitch_x_um"] = data.pixel_pitch_x_um ? Json(*data.pixel_pitch_x_um) : Json(nullptr);
  json["pixel_pitch_y_um"] = data.pixel_pitch_y_um ? Json(*data.pixel_pitch_y_um) : Json(nullptr);
  json["operator"] = focus_operator_name(data.focus.focus_operator);
  json["window_px"] = data.focus.window_px;
  json["distance_px"] = data.focus.distance_px;
  json["min_prominence"] = data.focus.min_prominence;
  json["min_significance"] = data.focus.min_significance;
  json["bin_slices"] = data.focus.bin_slices;
  json["noise_grey"] = rounded(data.map.noise_grey, 3);
  json["curve_width_um"] = data.map.curve_width_um > 0.0 ? um(data.map.curve_width_um) : Json(nullptr);
  json["peak"] = peak_method_name(data.peak);
  Json extra = Json::array();
  for (const auto& [method, map] : data.extra_maps) {
    extra.push_back({{"peak", peak_method_name(method)},
                     {"height", height_values(summarize_heights(map.height_m, map.sigma_m, map.mask))}});
  }
  json["extra_peaks"] = std::move(extra);
  json["state_bytes_per_pixel"] = rounded(data.state_bytes_per_pixel, 3);
  return json;
}

Json stage_health(const StageCorrection& stage) {
  return {{"corrected", stage.applied},
          {"reason", text_or_null(stage.reason)},
          {"offsets_rms_um", um(stage.rms_um)},
          {"offset_error_um", um(stage.standard_error_um)}};
}

Json frames(const FrameCounts& counts) {
  return {{"expected", counts.expected}, {"ok", counts.ok},       {"incomplete", counts.incomplete},
          {"missing", counts.missing},   {"stale", counts.stale}, {"underrun", counts.underrun}};
}

Json slices(const ResultData& data) {
  std::size_t measured = 0;
  for (const StepRecord& step : data.steps) measured += step.measured ? 1 : 0;
  Json json{{"planned", data.slices_planned}, {"measured", measured}};
  json["scan_mode"] = data.scan_mode == ScanMode::kContinuous ? "continuous" : "step";
  if (data.scan_mode == ScanMode::kContinuous) {
    json["speed_um_per_s"] = um(data.speed_um_per_s);
    json["ramp_frames"] = data.ramp_frames;
  }
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

Json provenance(const ResultData& data) {
  return {{"recipe", text_or_null(data.recipe_id)},
          {"recipe_sha256", text_or_null(data.recipe_sha256)},
          {"software_version", text_or_null(data.software_version)},
          {"simulated", data.simulated},
          {"created", iso8601_utc(data.created)},
          {"source", text_or_null(data.source)}};
}

/// One entry a file; the files of a folder, e.g. recorded slices, share one.
Json file_list(const std::vector<AtomicDirectory::File>& files) {
  Json list = Json::array();
  std::map<std::string, std::size_t> folders;  // name -> place in the list
  for (const auto& file : files) {
    const auto slash = file.name.find('/');
    if (slash == std::string::npos) {
      list.push_back({{"name", file.name}, {"size_bytes", file.size_bytes}});
      continue;
    }
    const std::string folder = file.name.substr(0, slash + 1);
    const auto [place, is_new] = folders.try_emplace(folder, list.size());
    if (is_new) list.push_back({{"name", folder}, {"files", 0}, {"size_bytes", 0}});
    Json& entry = list[place->second];
    entry["files"] = entry["files"].get<std::uint64_t>() + 1;
    entry["size_bytes"] = entry["size_bytes"].get<std::uint64_t>() + file.size_bytes;
  }
  return list;
}

}  // namespace

std::string result_json_text(const ResultData& data, const HeightSummary& summary,
                             const std::optional<WriteReport>& report) {
  Json json;
  json["job"] = {{"job_id", text_or_null(data.job_id)},
                 {"seq", data.seq ? Json(*data.seq) : Json(nullptr)},
                 {"part_id", text_or_null(data.part_id)},
                 {"recipe", text_or_null(data.recipe_id)}};
  json["values"] = values(summary);
  json["focus"] = focus(data);
  json["frames"] = frames(data.frames);
  json["slices"] = slices(data);
  json["steps"] = steps(data.step_summary);
  json["stage_in_curves"] = stage_health(data.map.stage);
  json["times"] = {{"prepare_ms", ms(data.times.prepare_ms)},
                   {"scan_ms", ms(data.times.scan_ms)},
                   {"finish_ms", ms(data.times.finish_ms)}};
  if (report) json["times"]["write_ms"] = ms(report->write_ms);
  json["provenance"] = provenance(data);
  if (report) json["files"] = file_list(report->files);
  return json.dump(2, ' ', true, Json::error_handler_t::replace) + "\n";
}

}  // namespace fvd
