/// Results of jobs that ended.

#include "daemon/api/methods/device_task.hpp"
#include "daemon/api/methods/job_key_params.hpp"
#include "daemon/api/methods/methods.hpp"
#include "daemon/api/replies.hpp"
#include "daemon/api/result_fields.hpp"
#include "daemon/api/result_shapes.hpp"

namespace fvd {

namespace {

struct GetParams {
  JobKeyParams job;
  std::string format = "compact";
  ClientParam client;
  std::vector<std::string> fields;

  void describe(Fields& described) {
    job.describe(described);
    described.choice("format", format, {"compact", "full", "complete"},
                     "compact: at most 440 bytes; full: at most 1400 bytes, and the warnings; complete: result.json, "
                     "of any length");
    client.describe(described);
    describe_fields_param(described, fields, names_in<describe_result>());
  }
};

struct EvaluateParams {
  JobKeyParams job;
  std::string recipe;
  ClientParam client;

  void describe(Fields& fields) {
    job.describe(fields);
    fields.text("recipe", recipe, kMaxForeignText_bytes, "id of the recipe whose section evaluation is done");
    fields.require("recipe");
    client.describe(fields);
  }
};

void describe_new_record(Fields& fields) {
  const ResultFields result(fields);
  result.text("id", "of the new record, for result.get: the job's with -e1, -e2, ...");
  result.text("job_id", "whose surface was evaluated");
  result.text("recipe", "as given");
  result.any("verdict", "pass, fail, uncertain, invalid; null where nothing is limited");
  result.text("directory", "with result.json and report.pdf");
}

void describe_acknowledged(Fields& fields) {
  ResultFields(fields).integer("remaining", "results that are not acknowledged yet");
}

Reply result_of(const Services& services, const JobKey& key, const ReplyForm& form, std::size_t envelope_bytes) {
  const StoredJob stored = services.results.stored(key);
  require_not_removed(stored.status);
  return result_reply(stored, form, envelope_bytes);
}

}  // namespace

void add_result_methods(MethodTable& methods, const Services& services) {
  using enum ErrorCode;
  methods["result.get"] = {.about = {.summary = "The result of a job; the same answer every time",
                                     .role = Role::kView,
                                     .params = described<GetParams>(),
                                     .result = describe_result,
                                     .errors = {kUnknownJob, kResultRemoved},
                                     .is_brief = true},
                           .run = with<GetParams>([services](const Call& call, const GetParams& params) {
                             return result_of(services, params.job.key(params.client),
                                              {reply_format(params.format), params.fields}, call.envelope_bytes);
                           })};
  methods["result.evaluate"] = {
      .about = {.summary =
                    "Evaluates a stored result's surface by another recipe: a new record; the job's result stays",
                .role = Role::kSetUp,
                .params = described<EvaluateParams>(),
                .result = describe_new_record,
                .errors = {kBusy, kUnknownJob, kResultRemoved, kUnknownRecipe, kBadRecipe, kBadInput, kSurfaceFile,
                           kMemoryBudget, kTimeout, kShuttingDown, kStorageFull, kStorageWrite, kDatabase},
                .may_wait = true,
                .needs_id = true},
      .run = with<EvaluateParams>([&results = services.results](const Call& call, const EvaluateParams& params) {
        require_wait(call);
        return Answer(reply_when_done(results.evaluate(params.job.key(params.client), params.recipe)));
      })};
  methods["result.next"] = {
      .about = {.summary =
                    "The oldest result that was not acknowledged, of any client; job_id is empty if there is none",
                .role = Role::kView,
                .params = described<NoParams>(),
                .result = describe_next_result,
                .is_brief = true},
      .run = [services](const Call& call) -> Answer {
        const auto job = services.results.next_unacknowledged();
        return job ? result_of(services, job->job_id, {ReplyFormat::kCompact}, call.envelope_bytes)
                   : Reply{{"job_id", ""}};
      }};
  methods["result.ack"] = {
      .about = {.summary = "Acknowledges a result; nothing is deleted",
                .role = Role::kOperate,
                .params = described<OneJobParams>(),
                .result = describe_acknowledged,
                .errors = {kBusy, kUnknownJob, kDatabase, kStorageFull},
                .is_brief = true},
      .run = with<OneJobParams>([&results = services.results](const Call&, const OneJobParams& params) {
        return Reply{{"remaining", results.acknowledge(params.key())}};
      })};
}

}  // namespace fvd
