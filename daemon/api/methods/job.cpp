/// Jobs: start, follow, end.

#include <algorithm>

#include "daemon/api/json_shapes.hpp"
#include "daemon/api/methods/job_key_params.hpp"
#include "daemon/api/methods/methods.hpp"
#include "daemon/api/replies.hpp"
#include "daemon/api/result_fields.hpp"
#include "daemon/api/rpc_errors.hpp"

namespace fvd {

namespace {

constexpr std::int64_t kLongestWait_ms = 30000;

struct StartParams {
  std::int64_t seq = 1;
  std::string part_id;
  std::string recipe;
  ClientParam client;
  std::optional<double> temperature_c;
  std::string session;

  void describe(Fields& fields) {
    describe_seq(fields, seq, "chosen by the client; the same number is the same job");
    fields.require("seq");
    fields.text("part_id", part_id, kMaxForeignText_bytes, "1 to 64 printable ASCII characters");
    fields.require("part_id");
    fields.text("recipe", recipe, kMaxForeignText_bytes,
                "recipe id, the prepared one from then on; empty = the prepared one, which any client's job.start and "
                "recipe.prepare change");
    client.describe(fields);
    fields.optional("temperature_c", temperature_c, [](Fields& inner, double& value) {
      inner.number("temperature_c", value, {-50.0, 100.0},
                   "of the part, degrees Celsius; absent = as the configuration's temperature.file tells");
    });
    fields.text("session", session, kMaxForeignText_bytes,
                "of the client, e.g. its start: a number of another one is refused, never repeated");
  }
};

struct WaitParams {
  JobKeyParams job;
  std::string until = "done";
  std::int64_t timeout_ms = kLongestWait_ms;
  ClientParam client;
  ReplyFormParams form;

  void describe(Fields& fields) {
    job.describe(fields);
    fields.choice("until", until, {"acquired", "done"}, "acquired = the part may be moved");
    fields.integer64("timeout_ms", timeout_ms, {0, kLongestWait_ms}, "then the job's status comes as it is");
    client.describe(fields);
    form.describe(fields, names_in<describe_job_status>());
  }
};

void describe_started(Fields& fields) {
  const ResultFields result(fields);
  result.text("job_id", "the job's id");
  result.integer("seq", "as given");
  result.text("client", "whose seq");
  result.boolean("duplicate", "the number was known: the same job, no second motion");
  result.text("state", "processing, completed, aborted, failed");
}

void describe_latest(Fields& fields) {
  const ResultFields result(fields);
  result.text("job_id", "empty = the client has started none");
  result.integer("seq", "of the client's job with the highest, 0 = none");
  result.integer("newest_seq", "the highest that counts as used, 0 = none; the next number is one more");
}

const std::string& checked_part_id(const std::string& part_id) {
  const bool plain = std::all_of(part_id.begin(), part_id.end(), [](char c) { return c >= ' ' && c <= '~'; });
  if (part_id.empty() || !plain) {
    throw ProtocolError{json_rpc::kInvalidParams, "part_id must have 1 to 64 printable ASCII characters"};
  }
  return part_id;
}

/// The job of the key if it runs or was the latest: then the snapshot says what there is to say.
std::optional<JobStatus> latest_job(const MachineView& machine, const JobKey& key) {
  const auto snapshot = machine.snapshot();
  const auto& job = snapshot->job;
  if (!job || !names(key, *job)) return std::nullopt;
  return job;
}

Answer start_job(JobService& jobs, const Call& call, const StartParams& params) {
  const auto started = jobs.start({params.seq, checked_part_id(params.part_id), params.recipe, params.client.checked(),
                                   params.temperature_c, params.session, call.caller.received});
  return Reply{{"job_id", started.job.job_id},
               {"seq", params.seq},
               {"client", params.client.client},
               {"duplicate", started.duplicate},
               {"state", job_state_name(started.job.state)}};
}

Answer wait_for_job(const Services& services, const Call& call, const WaitParams& params) {
  const JobKey key = params.job.key(params.client);
  const auto latest = latest_job(services.machine, key);
  const JobStatus job = latest ? *latest : services.jobs.job(key);
  // In a batch a wait is out of place: there it answers at once.
  if (!call.may_wait) return job_status_reply(job, params.form.form(), call.envelope_bytes);
  return Deferred{JobWait{job.job_id, params.until == "acquired", params.form.form()},
                  std::chrono::milliseconds(params.timeout_ms)};
}

}  // namespace

void add_job_methods(MethodTable& methods, const Services& services) {
  using enum ErrorCode;
  methods["job.start"] = {
      .about = {.summary =
                    "Starts a measurement, and makes its recipe the prepared one; answers once its row is on disk",
                .role = Role::kOperate,
                .params = described<StartParams>(),
                .result = describe_started,
                .errors = {kNotReady, kBusy, kUnknownRecipe, kBadRecipe, kSeqConflict, kSeqStale, kShuttingDown,
                           kStageLimit, kObjectiveMismatch, kStorageFull, kStorageWrite, kDatabase, kMemoryBudget,
                           kRegionOutside},
                .moves_stage = true,
                .needs_control = true,
                .is_audited = true,
                .is_brief = true,
                .needs_id = true},
      .run = with<StartParams>([&jobs = services.jobs](const Call& call, const StartParams& params) {
        return start_job(jobs, call, params);
      })};
  methods["job.status"] = {
      .about = {.summary = "What a job is doing",
                .role = Role::kView,
                .params = described<JobStatusParams>(),
                .result = describe_job_status,
                .errors = {kUnknownJob},
                .is_brief = true},
      .peek = with<JobStatusParams>(
          [&machine = services.machine](const Call& call, const JobStatusParams& params) -> std::optional<Answer> {
            const auto job = latest_job(machine, params.key());
            return job ? std::optional<Answer>(job_status_reply(*job, params.form.form(), call.envelope_bytes))
                       : std::nullopt;
          }),
      .run = with<JobStatusParams>([&jobs = services.jobs](const Call& call, const JobStatusParams& params) {
        return job_status_reply(jobs.job(params.key()), params.form.form(), call.envelope_bytes);
      })};
  methods["job.wait"] = {
      .about = {.summary =
                    "Answers when the job is acquired or done; until then its connection holds up what needs the disk, "
                    "and answers everything else",
                .role = Role::kView,
                .params = described<WaitParams>(),
                .result = describe_job_status,
                .errors = {kUnknownJob},
                .may_wait = true,
                .is_brief = true},
      .run = with<WaitParams>(
          [services](const Call& call, const WaitParams& params) { return wait_for_job(services, call, params); })};
  methods["job.abort"] = {
      .about = {.summary = "Ends a job; no effect on one that has ended",
                .role = Role::kOperate,
                .params = described<JobStatusParams>(),
                .result = describe_job_status,
                .errors = {kUnknownJob},
                .is_urgent = true,
                .is_audited = true,
                .is_brief = true},
      .peek = with<JobStatusParams>(
          [&jobs = services.jobs](const Call& call, const JobStatusParams& params) -> std::optional<Answer> {
            const auto job = jobs.try_abort(params.key());
            return job ? std::optional<Answer>(job_status_reply(*job, params.form.form(), call.envelope_bytes))
                       : std::nullopt;
          }),
      .run = with<JobStatusParams>([&jobs = services.jobs](const Call& call, const JobStatusParams& params) {
        return job_status_reply(jobs.abort(params.key()), params.form.form(), call.envelope_bytes);
      })};
  methods["job.latest"] = {
      .about = {.summary = "A client's job with the highest seq; its next number is one more than newest_seq",
                .role = Role::kView,
                .params = described<ClientParam>(),
                .result = describe_latest,
                .is_brief = true},
      .run = with<ClientParam>([services](const Call&, const ClientParam& params) -> Answer {
        const auto job = services.jobs.highest(params.checked());
        const std::int64_t seq = job ? job->request.seq : 0;
        return Reply{{"job_id", job ? job->job_id : ""},
                     {"seq", seq},
                     {"newest_seq", std::max(seq, newest_seq(*services.machine.snapshot(), params.client))}};
      })};
}

}  // namespace fvd
