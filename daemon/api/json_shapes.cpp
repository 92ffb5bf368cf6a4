#include "daemon/api/json_shapes.hpp"

#include <algorithm>
#include <cmath>

#include "daemon/api/rpc_errors.hpp"

namespace fvd {

namespace {

using nlohmann::ordered_json;

constexpr std::size_t kLongestMessage = 200;

std::string shortened(const std::string& text) {
  return text.size() <= kLongestMessage ? text : text.substr(0, kLongestMessage - 3) + "...";
}

int code_of(const std::optional<ErrorCode>& error) { return error ? rpc_error(*error).code : 0; }

ordered_json error_of(const std::optional<ErrorCode>& error) {
  return error ? ordered_json(error_name(*error)) : ordered_json("");
}

}  // namespace

ordered_json job_status_json(const JobStatus& job) {
  const bool done = job.state != JobState::kProcessing;
  const double progress = job.slices_planned > 0 ? static_cast<double>(job.slices_done) / job.slices_planned : 0.0;
  return {{"job_id", job.job_id},
          {"seq", job.request.seq},
          {"part_id", job.request.part_id},
          {"recipe", job.request.recipe},
          {"state", job_state_name(job.state)},
          {"phase", job.phase},
          {"done", done},
          {"acquired", job.acquired},
          {"progress", std::round(progress * 1000) / 1000},
          {"slices_done", job.slices_done},
          {"slices_planned", job.slices_planned},
          {"frames_expected", job.frames.expected},
          {"frames_ok", job.frames.ok},
          {"acknowledged", job.acknowledged},
          {"error_code", code_of(job.error)},
          {"error", error_of(job.error)},
          {"error_message", shortened(job.error_message)}};
}

ordered_json machine_status_json(const MachineStatus& machine, std::int64_t hb) {
  return {{"state", scan_state_name(machine.state)},
          {"ready", machine.signals.ready},
          {"busy", machine.signals.busy},
          {"acquiring", machine.signals.acquiring},
          {"part_release", machine.signals.part_release},
          {"result_valid", machine.job && machine.job->state == JobState::kCompleted && !machine.job->acknowledged},
          {"results_waiting", machine.results_waiting},
          {"error_code", code_of(machine.error)},
          {"error", error_of(machine.error)},
          {"error_message", shortened(machine.error_message)},
          {"epoch", machine.epoch},
          {"hb", hb},
          {"seq", machine.job ? machine.job->request.seq : 0},
          {"job_id", machine.job ? machine.job->job_id : ""},
          {"recipe", machine.recipe},
          {"simulated", machine.simulated},
          {"mode", "automatic"}};
}

ordered_json compact_result_json(const JobStatus& job, const std::string& result_text) {
  ordered_json json{{"job_id", job.job_id},
                    {"seq", job.request.seq},
                    {"part_id", job.request.part_id},
                    {"state", job_state_name(job.state)},
                    {"error_code", code_of(job.error)}};
  if (result_text.empty()) return json;
  const auto result = ordered_json::parse(result_text);
  const auto& values = result.at("values");
  json["valid_fraction"] = values.at("valid_fraction");
  for (const char* key : {"min_um", "max_um", "mean_um"}) {
    json[std::string("height_") + key] = values.at("height").at(key);
  }
  json["frames_expected"] = result.at("frames").at("expected");
  json["frames_ok"] = result.at("frames").at("ok");
  json["simulated"] = result.at("provenance").at("simulated");
  return json;
}

ordered_json full_result_json(const JobStatus& job, const std::string& result_text, const std::string& directory) {
  ordered_json json{{"job_id", job.job_id},
                    {"seq", job.request.seq},
                    {"part_id", job.request.part_id},
                    {"recipe", job.request.recipe},
                    {"state", job_state_name(job.state)},
                    {"error_code", code_of(job.error)},
                    {"error", error_of(job.error)},
                    {"error_message", shortened(job.error_message)},
                    {"directory", directory}};
  if (result_text.empty()) return json;
  const auto result = ordered_json::parse(result_text);
  for (const char* key : {"values", "focus", "frames", "slices", "steps", "times"}) json[key] = result.at(key);
  // Per estimator figures and the list of files stand in the directory's result.json.
  json["focus"].erase("extra_peaks");
  json["simulated"] = result.at("provenance").at("simulated");
  return json;
}

nlohmann::ordered_json stage_history_json(const std::optional<StepHistorySummary>& history) {
  using Json = nlohmann::ordered_json;
  const StepHistorySummary summary = history.value_or(StepHistorySummary{});
  const auto value = [](const std::optional<double>& number) { return number ? Json(*number) : Json(nullptr); };
  return {{"scans", summary.scans},
          {"steps", summary.steps},
          {"lost_steps", summary.lost_steps},
          {"observable", summary.observable},
          {"error_mean_um", value(summary.error_mean_um)},
          {"error_sd_um", value(summary.error_sd_um)},
          {"error_max_um", value(summary.error_max_um)},
          {"error_p95_um", value(summary.error_p95_um)},
          {"increment_error_mean_um", value(summary.increment_error_mean_um)},
          {"increment_error_sd_um", value(summary.increment_error_sd_um)},
          {"increment_error_max_um", value(summary.increment_error_max_um)},
          {"move_p50_ms", value(summary.move_p50_ms)},
          {"move_p95_ms", value(summary.move_p95_ms)},
          {"move_max_ms", value(summary.move_max_ms)}};
}

}  // namespace fvd
