#include "daemon/ctl/job_commands.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/error.hpp"
#include "daemon/ctl/exit_codes.hpp"
#include "daemon/ctl/progress_line.hpp"

namespace fvd::ctl {

namespace {

// Longest time for which the daemon holds its answer back while the job runs: the client never sleeps.
constexpr std::chrono::milliseconds kWatchHold{200};
constexpr std::chrono::milliseconds kWaitHold{10000};

/// job.wait until done or `hold` has passed.
Json poll_job(RpcClient& client, const Json& key, std::chrono::milliseconds hold) {
  Json params = key;
  params["until"] = "done";
  params["timeout_ms"] = hold.count();
  Json status = client.call("job.wait", params, hold + RpcClient::kReplyTimeout);
  if (!status.is_object() || !status.contains("state") || !status["state"].is_string()) {
    throw Error(ErrorCode::kInternal, "the status of the job has no state: " + status.dump());
  }
  return status;
}

bool has_ended(const Json& status) { return status["state"] != "processing"; }

std::string progress_text(const Json& status) {
  const std::string phase = status.value("phase", std::string());
  const double fraction = status.value("progress", 0.0);
  std::string text = has_ended(status) ? status["state"].get<std::string>() : phase;
  text += "  slice " + std::to_string(status.value("slices_done", 0)) + "/" +
          std::to_string(status.value("slices_planned", 0)) + "  " +
          std::to_string(std::lround(std::clamp(fraction, 0.0, 1.0) * 100)) + " %";
  if (status.value("acquired", false)) text += "  part may be moved";
  return text;
}

std::string latest_job_id(const Json& state) {
  for (const Json& place : {state, state.value("job", Json::object())}) {
    if (place.is_object() && place.contains("job_id") && place["job_id"].is_string()) {
      return place["job_id"].get<std::string>();
    }
  }
  return {};
}

}  // namespace

Json job_key(RpcClient& client, const std::string& job, const std::string& owner) {
  if (job.empty()) {
    const std::string id = latest_job_id(client.call("system.state"));
    if (id.empty()) throw Error(ErrorCode::kUnknownJob, "the daemon has run no job yet");
    return {{"job_id", id}};
  }
  constexpr std::size_t kMaxSeqDigits = 16;  // of 2^53 - 1
  const bool number = job.size() <= kMaxSeqDigits && job.find_first_not_of("0123456789") == std::string::npos;
  return number ? Json{{"seq", std::stoll(job)}, {"client", owner}} : Json{{"job_id", job}};
}

Json start_job(RpcClient& client, const StartOptions& options, const std::string& owner) {
  std::int64_t seq = options.seq.value_or(0);
  if (!options.seq) {
    const Json latest = client.call("job.latest", {{"client", owner}});
    seq = latest.value("newest_seq", latest.value("seq", std::int64_t{0})) + 1;
  }
  Json params{{"seq", seq}, {"part_id", options.part_id}, {"client", owner}};
  if (!options.recipe.empty()) params["recipe"] = options.recipe;
  if (options.temperature_c) params["temperature_c"] = *options.temperature_c;
  return client.call("job.start", params);
}

Json watch_job(RpcClient& client, const Json& key, std::ostream& out, bool terminal) {
  ProgressLine line(out, terminal);
  for (;;) {
    Json status = poll_job(client, key, kWatchHold);
    line.update(status.value("progress", 0.0), progress_text(status));
    if (has_ended(status)) return status;
  }
}

Json wait_for_job(RpcClient& client, const Json& key) {
  for (;;) {
    Json status = poll_job(client, key, kWaitHold);
    if (has_ended(status)) return status;
  }
}

int job_exit_code(const Json& status) { return status["state"] == "completed" ? kExitOk : kExitJobFailed; }

}  // namespace fvd::ctl
