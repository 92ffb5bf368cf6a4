#include <algorithm>

#include "daemon/api/json_shapes.hpp"
#include "daemon/api/methods.hpp"
#include "daemon/api/replies.hpp"
#include "daemon/api/rpc_errors.hpp"

namespace fvd {

namespace {

using nlohmann::json;
using nlohmann::ordered_json;

constexpr std::int64_t kLongestWait_ms = 30000;

std::string checked_part_id(const std::string& part_id) {
  const bool plain = std::all_of(part_id.begin(), part_id.end(), [](char c) { return c >= ' ' && c <= '~'; });
  if (part_id.empty() || part_id.size() > 64 || !plain) {
    throw ProtocolError{json_rpc::kInvalidParams, "part_id must have 1 to 64 printable ASCII characters"};
  }
  return part_id;
}

/// The job of the key if it runs: then the snapshot says what there is to say.
std::optional<JobStatus> running_job(const MachineView& machine, const JobKey& key) {
  const auto snapshot = machine.snapshot();
  const auto& job = snapshot->job;
  if (!job || job->state != JobState::kProcessing) return std::nullopt;
  return names(key, *job) ? job : std::nullopt;
}

Reply start_job(const Services& services, const json& params) {
  const auto seq = params["seq"].get<std::int64_t>();
  const auto started =
      services.jobs.start({seq, checked_part_id(params["part_id"].get<std::string>()), text_or(params, "recipe", "")});
  return ordered_json{{"job_id", started.job.job_id},
                      {"seq", seq},
                      {"duplicate", started.duplicate},
                      {"state", job_state_name(started.job.state)}};
}

Reply wait_for_job(const Services& services, const Call& call) {
  const std::string until = text_or(call.params, "until", "done");
  if (until != "acquired" && until != "done") {
    throw ProtocolError{json_rpc::kInvalidParams, "until must be \"acquired\" or \"done\""};
  }
  const JobKey key = job_key_from(call.params);
  const auto running = running_job(services.machine, key);
  const JobStatus job = running ? *running : services.jobs.job(key);
  // In a batch a wait is out of place: there it answers at once.
  if (!call.may_wait) return job_status_json(job);
  const auto timeout_ms = call.params.value("timeout_ms", kLongestWait_ms);
  return Deferred{JobWait{job.job_id, until == "acquired"}, std::chrono::milliseconds(timeout_ms)};
}

}  // namespace

std::vector<Param> job_key_params() {
  return {{"job_id", ParamType::kText, false, "the job, by its id"},
          {"seq", ParamType::kInteger, false, "or by its sequence number",
           ParamRange{1.0, static_cast<double>(kLargestExactInteger)}}};
}

JobKey job_key_from(const json& params) {
  if (params.contains("job_id") == params.contains("seq")) {
    throw ProtocolError{json_rpc::kInvalidParams, "name the job by job_id or by seq, one of the two"};
  }
  if (params.contains("job_id")) return params["job_id"].get<std::string>();
  return ClientSeq{params["seq"].get<std::int64_t>()};
}

std::string text_or(const json& params, const char* name, const std::string& fallback) {
  const auto found = params.find(name);
  return found == params.end() ? fallback : found->get<std::string>();
}

void add_job_methods(MethodTable& methods, const Services& services) {
  methods["job.start"] = {.summary = "Starts a measurement; the same seq is the same job, never a second motion",
                          .params = {{"seq", ParamType::kInteger, true, "1..2^53-1, chosen by the client",
                                      ParamRange{1.0, static_cast<double>(kLargestExactInteger)}},
                                     {"part_id", ParamType::kText, true, "1..64 printable ASCII characters"},
                                     {"recipe", ParamType::kText, false, "recipe id; absent = the prepared one"}},
                          .run = [services](const Call& call) { return start_job(services, call.params); },
                          .needs_id = true};
  methods["job.status"] = {
      .summary = "What a job is doing",
      .params = job_key_params(),
      .peek = [services](const Call& call) -> std::optional<Reply> {
        const auto job = running_job(services.machine, job_key_from(call.params));
        return job ? std::optional<Reply>(job_status_json(*job)) : std::nullopt;
      },
      .run = [services](const Call& call) { return job_status_json(services.jobs.job(job_key_from(call.params))); }};
  auto wait_params = job_key_params();
  wait_params.push_back({"until", ParamType::kText, false, "\"acquired\" or \"done\" (the default)"});
  wait_params.push_back({"timeout_ms", ParamType::kInteger, false, "0..30000, default 30000; then done is false",
                         ParamRange{0.0, static_cast<double>(kLongestWait_ms)}});
  methods["job.wait"] = {.summary = "Answers when the job is acquired or done",
                         .params = wait_params,
                         .run = [services](const Call& call) { return wait_for_job(services, call); }};
  methods["job.abort"] = {
      .summary = "Ends a job; no effect on one that has ended",
      .params = job_key_params(),
      .run = [services](const Call& call) { return job_status_json(services.jobs.abort(job_key_from(call.params))); }};
}

}  // namespace fvd
