#include "daemon/api/json_shapes.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "daemon/api/compact_evaluation.hpp"
#include "daemon/api/result_fields.hpp"
#include "daemon/api/rpc_errors.hpp"

namespace fvd {

namespace {

using nlohmann::ordered_json;

constexpr std::size_t kLongestMessage_bytes = 200;
/// What a full result repeats of result.json.
constexpr std::array kFullGroups{"values", "focus", "frames", "slices", "steps", "times"};
/// Of formats 2 and later; the last two only of results that were evaluated anew.
constexpr std::array kFullLists{"verdict", "warnings", "evaluated", "source"};

std::string shortened(const std::string& text) {
  return text.size() <= kLongestMessage_bytes ? text : text.substr(0, kLongestMessage_bytes - 3) + "...";
}

int code_of(const std::optional<ErrorCode>& error) { return error ? rpc_error(*error).code : 0; }

/// As OPC 40001-101 names it: what the result says of the part.
std::string_view evaluation_of(const JobStatus& job) {
  if (job.verdict == "pass") return "ok";
  if (job.verdict == "fail") return "nok";
  if (job.verdict == "uncertain" || job.verdict == "invalid") return job.verdict;
  return "undefined";
}

ordered_json error_of(const std::optional<ErrorCode>& error) {
  return error ? ordered_json(error_name(*error)) : ordered_json("");
}

}  // namespace

void describe_job_status(Fields& fields) {
  const ResultFields result(fields);
  result.text("job_id", "the job's id");
  result.integer("seq", "its client's number");
  result.text("client", "whose seq");
  result.text("part_id", "as given");
  result.text("recipe", "recipe id");
  result.text("state", "processing, completed, aborted, failed");
  result.text("evaluation", "of the part: ok, nok, uncertain, invalid; undefined where nothing was judged");
  result.text("reason_codes", "why values are missing or uncertain: numbers with commas between; may be empty");
  result.text("phase", "preparing, acquiring, computing, storing; empty when ended");
  result.boolean("done", "the job has ended");
  result.boolean("acquired", "the part may be moved: no more slices, and standstill was measured");
  result.number("progress", "0..1, of the slices");
  result.integer("slices_done", "so far");
  result.integer("slices_planned", "of the recipe");
  result.integer("frames_expected", "so far, repeated ones too");
  result.integer("frames_ok", "so far");
  result.boolean("acknowledged", "by result.ack");
  result.integer("error_code", "why it failed or was aborted; 0 = no error");
  result.text("error", "the error's name; empty = no error");
  result.text("error_message", "for people, at most 200 bytes");
  result.boolean("durable", "a restart does not change what is told here; false: the end is not stored yet");
  result.text("ended_utc", "when it ended; empty = it has not");
  result.integer("age_s", "seconds since it ended; 0 = it has not");
  result.text("warning", "why it is not, at most 200 bytes; no job is taken before it is; empty = no warning");
}

ordered_json job_status_json(const JobStatus& job) {
  const bool done = job.state != JobState::kProcessing;
  // A camera that is faster than asked takes more slices than planned.
  const double progress =
      job.slices_planned > 0 ? std::min(1.0, static_cast<double>(job.slices_done) / job.slices_planned) : 0.0;
  return {{"job_id", job.job_id},
          {"seq", job.request.seq},
          {"client", job.request.client},
          {"part_id", job.request.part_id},
          {"recipe", job.request.recipe},
          {"state", job_state_name(job.state)},
          {"evaluation", evaluation_of(job)},
          {"reason_codes", job.reason_codes},
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
          {"error_message", shortened(job.error_message)},
          {"durable", job.not_durable.empty()},
          {"ended_utc", job.ended_utc},
          {"age_s", seconds_since(job.ended_utc)},
          {"warning", shortened(job.not_durable)}};
}

void describe_machine_status(Fields& fields) {
  const ResultFields result(fields);
  result.text("state", "preoperational, initialized, ready, executing, error, halted");
  result.boolean("ready", "a job would be accepted");
  result.boolean("busy", "a job runs, or a command that moves the stage");
  result.boolean("acquiring", "the part must not move");
  result.boolean("part_release", "the part may be taken: standstill was measured");
  result.boolean("result_valid", "a completed job is not acknowledged: result.next");
  result.integer("results_waiting", "ended jobs that are not acknowledged");
  result.boolean("overrun", "more results wait than rpc.fifo_results; none is dropped");
  result.integer("error_code", "why the state is error: a device, or where results are kept; 0 = no error");
  result.text("error", "the error's name; empty = no error");
  result.text("error_message", "for people, at most 200 bytes");
  result.integer("epoch", "counts the daemon's starts");
  result.integer("hb", "heartbeat: counts up once a second");
  result.integer("seq", "of the running or latest job; 0 = none");
  result.integer("newest_seq", "of the client that is asked for, 0 = none; its next number is one more");
  result.text("client", "of that job; empty = no job");
  result.text("evaluation", "of that job's part: ok, nok, uncertain, invalid; undefined where nothing was judged");
  result.text("job_id", "of the running or latest job; empty = none");
  result.text("recipe", "the prepared recipe; empty = none");
  result.boolean("simulated", "a device is simulated");
  result.text("mode", "automatic");
  result.text("objective", "that was confirmed; empty = none");
}

std::int64_t newest_seq(const MachineStatus& machine, const std::string& client) {
  if (!machine.newest_seqs) return 0;
  const auto found = machine.newest_seqs->find(client);
  return found == machine.newest_seqs->end() ? 0 : found->second;
}

ordered_json machine_status_json(const MachineStatus& machine, const std::string& client, std::int64_t hb) {
  return {{"state", scan_state_name(machine.state)},
          {"ready", machine.signals.ready},
          {"busy", machine.signals.busy},
          {"acquiring", machine.signals.acquiring},
          {"part_release", machine.signals.part_release},
          {"result_valid", machine.result_valid},
          {"results_waiting", machine.results_waiting},
          {"overrun", machine.overrun},
          {"error_code", code_of(machine.error)},
          {"error", error_of(machine.error)},
          {"error_message", shortened(machine.error_message)},
          {"epoch", machine.epoch},
          {"hb", hb},
          {"seq", machine.job ? machine.job->request.seq : 0},
          {"newest_seq", newest_seq(machine, client)},
          {"client", machine.job ? machine.job->request.client : ""},
          {"evaluation", machine.job ? evaluation_of(*machine.job) : "undefined"},
          {"job_id", machine.job ? machine.job->job_id : ""},
          {"recipe", machine.recipe},
          {"simulated", machine.simulated},
          {"mode", "automatic"},
          {"objective", machine.objective}};
}

namespace {

void describe_compact(Fields& fields, Presence presence) {
  const ResultFields result(fields);
  result.text("job_id", "the job's id");
  result.integer("seq", "its client's number", presence);
  result.text("client", "whose seq; not in a compact result with an evaluation", Presence::kSometimes);
  result.text("part_id", "as given", presence);
  result.text("state", "completed, aborted, failed; processing while there is no result", presence);
  result.integer("error_code", "0 = no error", presence);
  result.number("valid_fraction", "of the points", Presence::kSometimes);
  result.number("height_min_um", "of the valid points", Presence::kSometimes);
  result.number("height_max_um", "of the valid points", Presence::kSometimes);
  result.number("height_mean_um", "of the valid points", Presence::kSometimes);
  result.integer("frames_expected", "compact: repeated ones too", Presence::kSometimes);
  result.integer("frames_ok", "compact", Presence::kSometimes);
  result.boolean("simulated", "a device was simulated", Presence::kSometimes);
  result.integer("warnings_count", "compact: what lowers trust; the full result says what", Presence::kSometimes);
  describe_compact_evaluation(fields);
  result.integer("age_s", "seconds since the job ended", Presence::kSometimes);
  result.text("ended_utc", "full, complete: when the job ended", Presence::kSometimes);
  result.boolean("durable", "false while the end is not stored yet: job.status tells why", Presence::kSometimes);
}

}  // namespace

void describe_next_result(Fields& fields) { describe_compact(fields, Presence::kSometimes); }

void describe_result(Fields& fields) {
  describe_compact(fields, Presence::kAlways);
  const ResultFields result(fields);
  result.any("result", "complete: result.json", Presence::kSometimes);
  result.text("recipe", "full: recipe id", Presence::kSometimes);
  result.text("error", "full: the error's name", Presence::kSometimes);
  result.text("error_message", "full: for people", Presence::kSometimes);
  result.text("directory", "full, complete: where the files are", Presence::kSometimes);
  for (const char* group : kFullGroups) result.any(group, "full: as in result.json", Presence::kSometimes);
  for (const char* list : kFullLists) result.any(list, "full: as in result.json", Presence::kSometimes);
}

ordered_json compact_result_json(const JobStatus& job, const std::string& result_text) {
  ordered_json json{{"job_id", job.job_id},
                    {"seq", job.request.seq},
                    {"client", job.request.client},
                    {"part_id", job.request.part_id},
                    {"state", job_state_name(job.state)},
                    {"error_code", code_of(job.error)}};
  if (!job.not_durable.empty()) json["durable"] = false;
  if (!job.ended_utc.empty()) json["age_s"] = seconds_since(job.ended_utc);
  if (result_text.empty()) return json;
  const auto result = ordered_json::parse(result_text);
  if (result.contains("evaluation")) {
    json.erase("client");  // who asks knows whose number it is; its bytes hold a value
    json["warnings_count"] = result["warnings"].size();
    json["simulated"] = result.at("provenance").at("simulated");
    add_compact_evaluation(result["evaluation"], json);
    return json;
  }
  const auto& values = result.at("values");
  json["valid_fraction"] = values.at("valid_fraction");
  for (const char* key : {"min_um", "max_um", "mean_um"}) {
    const auto& value = values.at("height").at(key);
    if (!value.is_null()) json[std::string("height_") + key] = value;
  }
  json["frames_expected"] = result.at("frames").at("expected");
  json["frames_ok"] = result.at("frames").at("ok");
  json["warnings_count"] = result.contains("warnings") ? result["warnings"].size() : 0;
  json["simulated"] = result.at("provenance").at("simulated");
  return json;
}

namespace {

void note_end(const JobStatus& job, ordered_json& json) {
  if (job.ended_utc.empty()) return;
  json["ended_utc"] = job.ended_utc;
  json["age_s"] = seconds_since(job.ended_utc);
}

}  // namespace

ordered_json complete_result_json(const JobStatus& job, const std::string& result_text, const std::string& directory) {
  ordered_json json{{"job_id", job.job_id},
                    {"seq", job.request.seq},
                    {"client", job.request.client},
                    {"part_id", job.request.part_id},
                    {"state", job_state_name(job.state)},
                    {"error_code", code_of(job.error)},
                    {"directory", directory}};
  if (!job.not_durable.empty()) json["durable"] = false;
  note_end(job, json);
  if (!result_text.empty()) json["result"] = ordered_json::parse(result_text);
  return json;
}

ordered_json full_result_json(const JobStatus& job, const std::string& result_text, const std::string& directory) {
  ordered_json json{{"job_id", job.job_id},
                    {"seq", job.request.seq},
                    {"client", job.request.client},
                    {"part_id", job.request.part_id},
                    {"recipe", job.request.recipe},
                    {"state", job_state_name(job.state)},
                    {"error_code", code_of(job.error)},
                    {"error", error_of(job.error)},
                    {"error_message", shortened(job.error_message)},
                    {"directory", directory}};
  if (!job.not_durable.empty()) json["durable"] = false;
  note_end(job, json);
  if (result_text.empty()) return json;
  const auto result = ordered_json::parse(result_text);
  for (const char* key : kFullGroups) json[key] = result.at(key);
  for (const char* key : kFullLists) {
    if (result.contains(key)) json[key] = result[key];
  }
  // Per estimator figures and the list of files stand in the directory's result.json.
  json["focus"].erase("extra_peaks");
  // A flag instead of the list: how many frames must not be believed; warnings say which.
  auto& slices = json["slices"];
  if (slices.contains("suspect")) slices["suspect_count"] = slices["suspect"].size();
  slices.erase("suspect");
  json["simulated"] = result.at("provenance").at("simulated");
  return json;
}

void describe_stage_history(Fields& fields) {
  const ResultFields result(fields);
  result.integer("scans", "step scans so far");
  result.integer("steps", "of all scans");
  result.integer("lost_steps", "ended beside their target");
  result.boolean("observable", "the stage measures its position itself");
  for (const char* name : {"error_mean_um", "error_sd_um", "error_max_um", "error_p95_um"}) {
    result.any(name, "measured minus commanded position; null = not observable");
  }
  for (const char* name : {"increment_error_mean_um", "increment_error_sd_um", "increment_error_max_um"}) {
    result.any(name, "measured minus commanded distance of neighbours; null = not observable");
  }
  for (const char* name : {"move_p50_ms", "move_p95_ms", "move_max_ms"}) {
    result.any(name, "time of a step; null = none yet");
  }
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
