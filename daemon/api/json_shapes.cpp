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

/// What a line polls while a job runs: whose, how far, and whether the part may go.
constexpr std::array<std::string_view, 11> kCompactJob{"seq",     "part_id",      "state",    "evaluation",
                                                       "done",    "acquired",     "progress", "error_code",
                                                       "durable", "acknowledged", "age_s"};
constexpr std::array<std::string_view, 15> kCompactMachine{
    "state",      "ready", "busy", "acquiring", "part_release", "result_valid", "results_waiting", "overrun",
    "error_code", "epoch", "hb",   "seq",       "newest_seq",   "client",       "simulated"};

/// As OPC 40001-101 names it: what the result says of the part.
std::string_view evaluation_of(const JobStatus& job) {
  if (job.verdict == "pass") return "ok";
  if (job.verdict == "fail") return "nok";
  if (job.verdict == "uncertain" || job.verdict == "invalid") return job.verdict;
  return "undefined";
}

}  // namespace

int code_of(const std::optional<ErrorCode>& error) { return error ? rpc_error(*error).code : 0; }

ordered_json error_of(const std::optional<ErrorCode>& error) {
  return error ? ordered_json(error_name(*error)) : ordered_json("");
}

void describe_job_status(Fields& fields) {
  const ResultFields result(fields);
  constexpr auto kSometimes = Presence::kSometimes;
  result.text("job_id", 64, "the job's id; not in compact", kSometimes);
  result.integer("seq", kAnySeq, "its client's number");
  result.text("client", 32, "whose seq; not in compact", kSometimes);
  result.text("part_id", 64, "as given");
  result.text("recipe", 64, "recipe id; not in compact", kSometimes);
  result.choice("state", kJobStates, "how far the job is, and how it ended");
  result.choice("evaluation", kEvaluations, "of the part; undefined where nothing was judged");
  result.text("reason_codes", 64,
              "why values are missing or uncertain: numbers with commas between; may be empty; not in compact",
              kSometimes);
  result.choice("phase", {"preparing", "acquiring", "computing", "storing", ""},
                "of a job that is processing; empty when ended; not in compact", kSometimes);
  result.boolean("done", "the job has ended; whether its result was removed since (1018) result.get tells");
  result.boolean("acquired", "the part may be moved: no more slices, and standstill was measured");
  result.number("progress", {0.0, 1.0}, "of the slices");
  result.integer("slices_done", kAnyCount, "so far; not in compact", kSometimes);
  result.integer("slices_planned", kAnyCount, "of the recipe; not in compact", kSometimes);
  result.integer("frames_expected", kAnyCount, "so far, repeated ones too; not in compact", kSometimes);
  result.integer("frames_ok", kAnyCount, "so far; not in compact", kSometimes);
  result.boolean("acknowledged", "by result.ack");
  result.integer("error_code", kAnyErrorCode, "why it failed or was aborted; 0 = no error");
  result.text("error", 64, "the error's name; empty = no error; not in compact", kSometimes);
  result.text("error_message", kLongestMessage_bytes, "for people; not in compact", kSometimes);
  result.boolean("durable", "a restart does not change what is told here; false: the end is not stored yet");
  result.text("ended_utc", 24, "when it ended; empty = it has not; not in compact", kSometimes);
  result.integer("age_s", kAnySeq, "since it ended; 0 = it has not");
  result.text("warning", kLongestMessage_bytes,
              "why it is not durable; no job is taken before it is; empty = no warning; not in compact", kSometimes);
  describe_left_out(result);
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
          {"error_message", cut_text(job.error_message, kLongestMessage_bytes)},
          {"durable", job.not_durable.empty()},
          {"ended_utc", job.ended_utc},
          {"age_s", seconds_since(job.ended_utc)},
          {"warning", cut_text(job.not_durable, kLongestMessage_bytes)}};
}

void describe_machine_status(Fields& fields) {
  const ResultFields result(fields);
  constexpr auto kSometimes = Presence::kSometimes;
  result.choice("state", {"preoperational", "initialized", "ready", "executing", "error", "halted"},
                "for people: a program looks at the flags");
  result.boolean("ready", "a job would be accepted");
  result.boolean("busy", "a job runs, or a command that moves the stage");
  result.boolean("acquiring", "the part must not move");
  result.boolean("part_release", "the part may be taken: standstill was measured");
  result.boolean("result_valid", "a completed job is not acknowledged: result.next");
  result.integer("results_waiting", kAnyCount, "ended jobs that are not acknowledged");
  result.boolean("overrun", "more results wait than rpc.fifo_results; none is dropped");
  result.integer("error_code", kAnyErrorCode,
                 "why the state is error: a device, or where results are kept; 0 = no error");
  result.text("error", 64, "the error's name; empty = no error; not in compact", kSometimes);
  result.text("error_message", kLongestMessage_bytes, "for people; not in compact", kSometimes);
  result.integer("epoch", kAnySeq, "counts the daemon's starts");
  result.integer("hb", kAnySeq, "heartbeat: counts up once a second");
  result.integer("seq", kAnySeq, "of the running or latest job; 0 = none");
  result.integer("newest_seq", kAnySeq, "of the client that is asked for, 0 = none; its next number is one more");
  result.text("client", 32, "of that job; empty = no job");
  result.choice("evaluation", kEvaluations, "of that job's part; undefined where nothing was judged; not in compact",
                kSometimes);
  result.text("job_id", 64, "of the running or latest job; empty = none; not in compact", kSometimes);
  result.text("recipe", 64, "the prepared recipe; empty = none; not in compact", kSometimes);
  result.boolean("simulated", "a device is simulated");
  result.text("mode", 9, "automatic; not in compact", kSometimes);
  result.text("objective", 64, "that was confirmed; empty = none; not in compact", kSometimes);
  describe_left_out(result);
}

std::int64_t newest_seq(const MachineStatus& machine, const std::string& client) {
  if (!machine.newest_seqs) return 0;
  const auto found = machine.newest_seqs->find(client);
  return found == machine.newest_seqs->end() ? 0 : found->second;
}

ordered_json job_status_reply(const JobStatus& job, const ReplyForm& form, std::size_t envelope_bytes) {
  return formed(job_status_json(job), form, kCompactJob, envelope_bytes);
}

ordered_json machine_status_reply(const MachineStatus& machine, const std::string& client, std::int64_t hb,
                                  const ReplyForm& form, std::size_t envelope_bytes) {
  return formed(machine_status_json(machine, client, hb), form, kCompactMachine, envelope_bytes);
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
          {"error_message", cut_text(machine.error_message, kLongestMessage_bytes)},
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
