#include "daemon/api/json_shapes.hpp"
#include "daemon/api/methods.hpp"
#include "daemon/api/replies.hpp"
#include "daemon/api/rpc_errors.hpp"

namespace fvd {

using nlohmann::ordered_json;

namespace {

ordered_json result_of(const Services& services, const JobKey& key, const std::string& format) {
  if (format != "compact" && format != "full") {
    throw ProtocolError{json_rpc::kInvalidParams, "format must be \"compact\" or \"full\""};
  }
  const JobStatus job = services.jobs.job(key);
  if (format == "compact") return compact_result_json(job, services.results.result_json(key));
  return full_result_json(job, services.results.result_json(key), services.results.result_dir(key));
}

}  // namespace

void add_result_methods(MethodTable& methods, const Services& services) {
  auto get_params = job_key_params();
  get_params.push_back({"format", ParamType::kText, false, "\"compact\" (the default) or \"full\""});
  methods["result.get"] = {.summary = "The result of a job; the same answer every time",
                           .params = get_params,
                           .run = [services](const Call& call) {
                             return result_of(services, job_key_from(call.params),
                                              text_or(call.params, "format", "compact"));
                           }};
  methods["result.next"] = {.summary = "The oldest result that was not acknowledged; job_id is empty if there is none",
                            .params = {},
                            .run = [services](const Call&) {
                              const auto job = services.results.next_unacknowledged();
                              return job ? result_of(services, job->job_id, "compact") : ordered_json{{"job_id", ""}};
                            }};
  methods["result.ack"] = {
      .summary = "Acknowledges a result; nothing is deleted",
      .params = job_key_params(),
      .run = [services](const Call& call) {
        return ordered_json{{"remaining", services.results.acknowledge(job_key_from(call.params))}};
      }};
}

}  // namespace fvd
