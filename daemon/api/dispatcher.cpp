#include "daemon/api/dispatcher.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include "config/strict_json.hpp"
#include "daemon/api/json_shapes.hpp"
#include "daemon/api/rpc_errors.hpp"
#include "daemon/base/version.hpp"
#include "daemon/jobs/device_commands.hpp"
#include "daemon/recipes/recipe_book.hpp"

namespace fvd {

namespace {

using nlohmann::json;
using nlohmann::ordered_json;

constexpr std::int64_t kLargestExactInteger = (std::int64_t{1} << 53U) - 1;
constexpr std::int64_t kLongestWait_ms = 30000;
/// A command to the devices that takes longer hangs.
constexpr std::chrono::minutes kLongestTask{5};

/// An error of the protocol or the parameters, as against one of the machine.
struct ProtocolError {
  int code = 0;
  std::string message;
};

std::string to_line(const ordered_json& reply) {
  return reply.dump(-1, ' ', true, ordered_json::error_handler_t::replace);
}

ordered_json success(const json& id, ordered_json result) {
  return {{"jsonrpc", "2.0"}, {"id", id}, {"result", std::move(result)}};
}

ordered_json failure(const json& id, int code, const std::string& message, ordered_json data = nullptr) {
  ordered_json error{{"code", code}, {"message", message}};
  if (!data.is_null()) error["data"] = std::move(data);
  return {{"jsonrpc", "2.0"}, {"id", id}, {"error", std::move(error)}};
}

/// Text from outside is shown shortened, so that a reply keeps its size.
std::string quoted(const std::string& text) {
  return "'" + (text.size() > 64 ? text.substr(0, 61) + "..." : text) + "'";
}

bool is_valid_id(const json& id) {
  if (id.is_null()) return true;
  if (id.is_string()) return id.get_ref<const std::string&>().size() <= 64;
  if (!id.is_number_integer()) return false;
  if (id.is_number_unsigned()) return id.get<std::uint64_t>() <= static_cast<std::uint64_t>(kLargestExactInteger);
  return id.get<std::int64_t>() >= -kLargestExactInteger;
}

std::string text_or(const json& params, const char* name, const std::string& fallback) {
  const auto found = params.find(name);
  return found == params.end() ? fallback : found->get<std::string>();
}

std::int64_t integer_or(const json& params, const char* name, std::int64_t fallback) {
  const auto found = params.find(name);
  return found == params.end() ? fallback : found->get<std::int64_t>();
}

JobKey key_from(const json& params) {
  if (params.contains("job_id") == params.contains("seq")) {
    throw ProtocolError{json_rpc::kInvalidParams, "name the job by job_id or by seq, one of the two"};
  }
  if (params.contains("job_id")) return params["job_id"].get<std::string>();
  return params["seq"].get<std::int64_t>();
}

std::string checked_part_id(const std::string& part_id) {
  const bool plain = std::all_of(part_id.begin(), part_id.end(), [](char c) { return c >= ' ' && c <= '~'; });
  if (part_id.empty() || part_id.size() > 64 || !plain) {
    throw ProtocolError{json_rpc::kInvalidParams, "part_id must have 1 to 64 printable ASCII characters"};
  }
  return part_id;
}

bool has_come(const JobStatus& job, bool until_acquired) {
  return job.state != JobState::kProcessing || (until_acquired && job.acquired);
}

}  // namespace

Dispatcher::Dispatcher(const Services& services) : services_(services) {
  add_system_methods();
  add_recipe_methods();
  add_job_methods();
  add_result_methods();
  add_device_methods();
}

void Dispatcher::add(const std::string& name, Method method) { methods_.emplace(name, std::move(method)); }

std::int64_t Dispatcher::heartbeat() const {
  return std::chrono::duration_cast<std::chrono::seconds>(std::chrono::steady_clock::now() - started_).count();
}

void Dispatcher::add_system_methods() {
  add("system.ping", {"Heartbeat", {{"t", ParamType::kAny, false, "returned as it came"}}, [this](const Json& params) {
                        OrderedJson result{{"hb", heartbeat()}, {"epoch", services_.machine.snapshot()->epoch}};
                        if (params.contains("t")) result["t"] = params["t"];
                        return result;
                      }});
  add("system.info", {"Who answers", {}, [this](const Json&) {
                        return OrderedJson{{"name", "fvd"},
                                           {"version", kVersion},
                                           {"api", 1},
                                           {"simulated", services_.machine.snapshot()->simulated}};
                      }});
  add("system.state", {"The machine's state, flat and cheap to poll", {}, [this](const Json&) {
                         return machine_status_json(*services_.machine.snapshot(), heartbeat());
                       }});
  add("stage.accuracy", {"The stage's step errors over all scans so far", {}, [this](const Json&) {
                           return stage_history_json(services_.tasks.stage_history());
                         }});
  add("rpc.discover", {"OpenRPC description of all methods", {}, [this](const Json&) { return describe_methods(); }});
}

void Dispatcher::add_recipe_methods() {
  add("recipe.list", {"Ids of all recipes", {}, [this](const Json&) {
                        return OrderedJson{{"recipes", services_.recipes.recipe_ids()}};
                      }});
  add("recipe.get", {"One recipe", {{"id", ParamType::kText, true, "recipe id"}}, [this](const Json& params) {
                       const auto id = params["id"].get<std::string>();
                       Problems problems;
                       const auto recipe = parse_strict_json(services_.recipes.recipe_json(id), problems);
                       throw_if_any(problems, ErrorCode::kBadRecipe, "recipe " + id);
                       return OrderedJson{{"id", id}, {"recipe", *recipe}};
                     }});
  add("recipe.prepare", {"Checks a recipe and makes it the one for jobs that name none",
                         {{"id", ParamType::kText, true, "recipe id"}},
                         [this](const Json& params) {
                           services_.jobs.prepare(params["id"].get<std::string>());
                           return OrderedJson{{"recipe", params["id"]}};
                         }});
}

void Dispatcher::add_job_methods() {
  const std::vector<Param> which{{"job_id", ParamType::kText, false, "the job, by its id"},
                                 {"seq", ParamType::kInteger, false, "or by its sequence number"}};
  add("job.start", {"Starts a measurement; the same seq is the same job, never a second motion",
                    {{"seq", ParamType::kInteger, true, "1..2^53-1, chosen by the client"},
                     {"part_id", ParamType::kText, true, "1..64 printable ASCII characters"},
                     {"recipe", ParamType::kText, false, "recipe id; absent = the prepared one"}},
                    [this](const Json& params) {
                      const auto seq = params["seq"].get<std::int64_t>();
                      if (seq < 1 || seq > kLargestExactInteger) {
                        throw ProtocolError{json_rpc::kInvalidParams, "seq must lie within 1..9007199254740991"};
                      }
                      const auto started = services_.jobs.start(
                          {seq, checked_part_id(params["part_id"].get<std::string>()), text_or(params, "recipe", "")});
                      return OrderedJson{{"job_id", started.job.job_id},
                                         {"seq", seq},
                                         {"duplicate", started.duplicate},
                                         {"state", job_state_name(started.job.state)}};
                    }});
  add("job.status", {"What a job is doing", which,
                     [this](const Json& params) { return job_status_json(services_.jobs.job(key_from(params))); }});
  auto wait_params = which;
  wait_params.push_back({"until", ParamType::kText, false, "\"acquired\" or \"done\" (the default)"});
  wait_params.push_back({"timeout_ms", ParamType::kInteger, false, "0..30000, default 30000; then done is false"});
  // Runs only where waiting is out of place, in a batch: there it answers at once.
  add("job.wait", {"Answers when the job is acquired or done", wait_params,
                   [this](const Json& params) { return job_status_json(services_.jobs.job(key_from(params))); }});
  add("job.abort", {"Ends a job; no effect on one that has ended", which,
                    [this](const Json& params) { return job_status_json(services_.jobs.abort(key_from(params))); }});
}

void Dispatcher::add_result_methods() {
  const std::vector<Param> which{{"job_id", ParamType::kText, false, "the job, by its id"},
                                 {"seq", ParamType::kInteger, false, "or by its sequence number"}};
  const auto result = [this](const JobKey& key, const std::string& format) {
    if (format != "compact" && format != "full") {
      throw ProtocolError{json_rpc::kInvalidParams, "format must be \"compact\" or \"full\""};
    }
    const JobStatus job = services_.jobs.job(key);
    if (format == "compact") return compact_result_json(job, services_.results.result_json(key));
    return full_result_json(job, services_.results.result_json(key), services_.results.result_dir(key));
  };
  auto get_params = which;
  get_params.push_back({"format", ParamType::kText, false, "\"compact\" (the default) or \"full\""});
  add("result.get", {"The result of a job; the same answer every time", get_params, [result](const Json& params) {
                       return result(key_from(params), text_or(params, "format", "compact"));
                     }});
  add("result.next", {"The oldest result that was not acknowledged; job_id is empty if there is none",
                      {},
                      [this, result](const Json&) {
                        const auto job = services_.results.next_unacknowledged();
                        return job ? result(job->job_id, "compact") : OrderedJson{{"job_id", ""}};
                      }});
  add("result.ack", {"Acknowledges a result; nothing is deleted", which, [this](const Json& params) {
                       return OrderedJson{{"remaining", services_.results.acknowledge(key_from(params))}};
                     }});
}

void Dispatcher::add_task(const std::string& name, const std::string& summary, std::vector<Param> params,
                          std::function<std::shared_ptr<DeviceTask>(const Json& params)> begin) {
  add(name,
      {summary, std::move(params), [this, name, begin = std::move(begin)](const Json& given) {
         if (!may_wait_) {
           throw ProtocolError{json_rpc::kInvalidRequest, name + " takes time: not in a batch, and only with an id"};
         }
         begun_ = begin(given);
         return OrderedJson::object();
       }});
}

void Dispatcher::add_device_methods() {
  const std::vector<Param> light{
      {"recipe", ParamType::kText, false, "whose camera settings to use; absent = the defaults"},
      {"exposure_us", ParamType::kNumber, false, "in place of the recipe's"},
      {"gain_db", ParamType::kNumber, false, "in place of the recipe's"}};
  const auto settings = [this](const Json& params) {
    CameraSettings camera;
    if (params.contains("recipe")) {
      const auto id = params["recipe"].get<std::string>();
      camera = parse_recipe(services_.recipes.recipe_json(id), id).camera;
    }
    camera.trigger = TriggerMode::kSoftware;
    if (params.contains("exposure_us")) camera.exposure_us = params["exposure_us"].get<double>();
    if (params.contains("gain_db")) camera.gain_db = params["gain_db"].get<double>();
    return camera;
  };
  add_task("camera.snap", "Takes one image, writes it as PNG, and tells its grey levels", light,
           [this, settings](const Json& params) { return services_.tasks.submit(snap_work(settings(params))); });
  add_task("camera.preview", "A picture for the eye: one taken now, or the newest slice of the job that runs", light,
           [this, settings](const Json& params) { return services_.tasks.preview(settings(params)); });
  auto exposure = light;
  exposure.push_back(
      {"target", ParamType::kNumber, false, "brightness of the brightest 0.1 %, 0.1..0.95; default 0.8"});
  add_task("camera.suggest_exposure", "Seeks the exposure; leaves the camera as it was", exposure,
           [this, settings](const Json& params) {
             const double target = params.value("target", 0.8);
             if (!(target >= 0.1 && target <= 0.95)) {
               throw ProtocolError{json_rpc::kInvalidParams, "target must lie within 0.1..0.95"};
             }
             return services_.tasks.submit(exposure_work(settings(params), target));
           });
  auto range = light;
  range.push_back({"from_um", ParamType::kNumber, true, "lower end of the range"});
  range.push_back({"to_um", ParamType::kNumber, true, "upper end"});
  range.push_back({"step_um", ParamType::kNumber, false, "of the coarse scan; default a tenth of the range"});
  add_task("stage.autofocus", "Moves the stage to where the middle of the image is sharpest", range,
           [this, settings](const Json& params) {
             AutofocusPlan plan;
             plan.from = Micrometers{params["from_um"].get<double>()};
             plan.to = Micrometers{params["to_um"].get<double>()};
             plan.step = Micrometers{params.value("step_um", (plan.to - plan.from).value / 10.0)};
             return services_.tasks.submit(autofocus_work(settings(params), plan));
           });
  add_task("stage.home", "Finds the stage's reference; the stage MOVES", {},
           [this](const Json&) { return services_.tasks.submit(home_work()); });
  add_task("stage.move", "Moves the stage; its limits hold", {{"z_um", ParamType::kNumber, true, "where to"}},
           [this](const Json& params) {
             return services_.tasks.submit(move_work(Micrometers{params["z_um"].get<double>()}));
           });
}

nlohmann::ordered_json Dispatcher::describe_methods() const {
  static const std::map<ParamType, OrderedJson> kSchemas{{ParamType::kText, {{"type", "string"}}},
                                                         {ParamType::kInteger, {{"type", "integer"}}},
                                                         {ParamType::kNumber, {{"type", "number"}}},
                                                         {ParamType::kAny, OrderedJson::object()}};
  OrderedJson methods = OrderedJson::array();
  for (const auto& [name, method] : methods_) {
    OrderedJson params = OrderedJson::array();
    for (const Param& param : method.params) {
      params.push_back({{"name", param.name},
                        {"description", param.meaning},
                        {"required", param.required},
                        {"schema", kSchemas.at(param.type)}});
    }
    methods.push_back({{"name", name},
                       {"summary", method.summary},
                       {"params", params},
                       {"result", {{"name", "result"}, {"schema", {{"type", "object"}}}}}});
  }
  return {{"openrpc", "1.2.6"}, {"info", {{"title", "fvd"}, {"version", kVersion}}}, {"methods", methods}};
}

Handled Dispatcher::handle(std::string_view line) {
  Handled handled;
  Problems problems;
  const auto document = parse_strict_json(line, problems, JsonComments::kRefused);
  if (!document) {
    handled.reply = to_line(failure(nullptr, json_rpc::kParseError, "parse error: " + problems.front().message));
    handled.is_parse_error = true;
    return handled;
  }
  const auto reply = document->is_array() ? handle_batch(*document) : handle_request(*document, false, handled);
  if (reply) handled.reply = to_line(*reply);
  return handled;
}

std::optional<ordered_json> Dispatcher::handle_batch(const json& batch) {
  if (batch.empty()) return failure(nullptr, json_rpc::kInvalidRequest, "an empty batch");
  if (batch.size() > kMaxBatch) {
    return failure(nullptr, json_rpc::kInvalidRequest, "a batch may hold " + std::to_string(kMaxBatch) + " requests");
  }
  const auto starts = std::count_if(batch.begin(), batch.end(), [](const json& request) {
    return request.is_object() && request.contains("method") && request["method"] == "job.start";
  });
  if (starts > 1) return failure(nullptr, json_rpc::kInvalidRequest, "a batch may start one job");
  ordered_json replies = ordered_json::array();
  Handled unused;
  for (const json& request : batch) {
    if (auto reply = handle_request(request, true, unused)) replies.push_back(std::move(*reply));
  }
  if (replies.empty()) return std::nullopt;
  return replies;
}

std::optional<ordered_json> Dispatcher::handle_request(const json& request, bool in_batch, Handled& handled) {
  const auto invalid = [](const std::string& what) { return failure(nullptr, json_rpc::kInvalidRequest, what); };
  if (!request.is_object()) return invalid("a request is an object");
  const auto version = request.find("jsonrpc");
  if (version == request.end() || *version != "2.0") return invalid("jsonrpc must be \"2.0\"");
  const auto method = request.find("method");
  if (method == request.end() || !method->is_string()) return invalid("method must be a text");
  const bool notification = !request.contains("id");
  const json id = notification ? json(nullptr) : request["id"];
  if (!is_valid_id(id)) return invalid("id must be null, a text of at most 64 bytes, or an integer of at most 2^53-1");
  const json params = request.value("params", json::object());
  if (!params.is_object() && !params.is_array() && !params.is_null())
    return invalid("params must be an object or a list");
  const auto name = method->get<std::string>();
  std::optional<ordered_json> reply;
  try {
    if (!in_batch && !notification && name == "job.wait") {
      reply = run_method(name, params, id);  // refuses bad parameters and unknown jobs at once
      if (!reply->contains("error")) {
        handled.waiting = as_waiting(name, params, id);
        return std::nullopt;
      }
    } else {
      may_wait_ = !in_batch && !notification;
      begun_.reset();
      reply = run_method(name, params, id);
      if (begun_ && !reply->contains("error")) {
        handled.waiting = WaitingRequest{id, {}, false, kLongestTask, std::exchange(begun_, nullptr)};
        return std::nullopt;
      }
    }
  } catch (const ProtocolError& error) {
    reply = failure(id, error.code, error.message);
  }
  if (notification) return std::nullopt;
  return reply;
}

ordered_json Dispatcher::run_method(const std::string& name, const json& given, const json& id) {
  const auto method = methods_.find(name);
  if (method == methods_.end()) {
    throw ProtocolError{json_rpc::kMethodNotFound, "there is no method " + quoted(name) + "; rpc.discover lists them"};
  }
  json params = json::object();
  const auto& known = method->second.params;
  if (given.is_array()) {
    if (given.size() > known.size()) {
      throw ProtocolError{json_rpc::kInvalidParams,
                          name + " takes at most " + std::to_string(known.size()) + " parameters"};
    }
    for (std::size_t i = 0; i < given.size(); ++i) params[known[i].name] = given[i];
  } else if (given.is_object()) {
    params = given;
  }
  for (const auto& [key, value] : params.items()) {
    const auto param = std::find_if(known.begin(), known.end(), [&key = key](const Param& p) { return p.name == key; });
    if (param == known.end()) throw ProtocolError{json_rpc::kInvalidParams, name + " has no parameter " + quoted(key)};
    const bool fits = param->type == ParamType::kAny || (param->type == ParamType::kText && value.is_string()) ||
                      (param->type == ParamType::kInteger && value.is_number_integer()) ||
                      (param->type == ParamType::kNumber && value.is_number());
    if (!fits) {
      throw ProtocolError{json_rpc::kInvalidParams, quoted(key) + " must be " +
                                                        (param->type == ParamType::kText     ? "a text"
                                                         : param->type == ParamType::kNumber ? "a number"
                                                                                             : "an integer")};
    }
  }
  for (const Param& param : known) {
    if (param.required && !params.contains(param.name)) {
      throw ProtocolError{json_rpc::kInvalidParams, name + " needs the parameter " + quoted(param.name)};
    }
  }
  try {
    return success(id, method->second.run(params));
  } catch (const Error& error) {
    const RpcError wire = rpc_error(error.code());
    return failure(id, wire.code, error.what(),
                   {{"error", error_name(error.code())},
                    {"retry", wire.retry},
                    {"state", scan_state_name(services_.machine.snapshot()->state)}});
  } catch (const std::exception& error) {
    return failure(id, json_rpc::kInternalError, std::string("internal error: ") + error.what(),
                   {{"error", "internal"}});
  }
}

std::optional<WaitingRequest> Dispatcher::as_waiting(const std::string& name, const json& given, const json& id) const {
  json params = given.is_object() ? given : json::object();
  if (given.is_array()) {
    const auto& known = methods_.at(name).params;
    for (std::size_t i = 0; i < given.size(); ++i) params[known[i].name] = given[i];
  }
  const std::string until = text_or(params, "until", "done");
  if (until != "acquired" && until != "done") {
    throw ProtocolError{json_rpc::kInvalidParams, "until must be \"acquired\" or \"done\""};
  }
  const std::int64_t timeout_ms = integer_or(params, "timeout_ms", kLongestWait_ms);
  if (timeout_ms < 0 || timeout_ms > kLongestWait_ms) {
    throw ProtocolError{json_rpc::kInvalidParams, "timeout_ms must lie within 0..30000"};
  }
  return WaitingRequest{id, key_from(params), until == "acquired", std::chrono::milliseconds(timeout_ms)};
}

std::optional<std::string> Dispatcher::resume_task(const WaitingRequest& waiting, bool timed_out) {
  const auto outcome = waiting.task->outcome();
  if (outcome && !outcome->error) return to_line(success(waiting.id, OrderedJson::parse(outcome->json)));
  if (!outcome && !timed_out) return std::nullopt;
  const ErrorCode code = outcome ? *outcome->error : ErrorCode::kTimeout;
  const RpcError wire = rpc_error(code);
  return to_line(failure(waiting.id, wire.code, outcome ? outcome->message : "the command is not done in 5 minutes",
                         {{"error", error_name(code)}, {"retry", wire.retry}}));
}

std::optional<std::string> Dispatcher::resume(const WaitingRequest& waiting, bool timed_out) {
  if (waiting.task) return resume_task(waiting, timed_out);
  try {
    const JobStatus job = services_.jobs.job(waiting.key);
    if (!timed_out && !has_come(job, waiting.until_acquired)) return std::nullopt;
    return to_line(success(waiting.id, job_status_json(job)));
  } catch (const Error& error) {
    return to_line(
        failure(waiting.id, rpc_error(error.code()).code, error.what(), {{"error", error_name(error.code())}}));
  }
}

std::string Dispatcher::too_long() {
  return to_line(
      failure(nullptr, json_rpc::kInvalidRequest,
              "the line is longer than " + std::to_string(kMaxLineBytes) + " bytes; the connection is closed"));
}

std::string Dispatcher::foreign_protocol() {
  return to_line(
      failure(nullptr, json_rpc::kInvalidRequest,
              "this port takes JSON-RPC, one JSON text a line, no HTTP and no TLS; the connection is closed"));
}

std::string Dispatcher::no_json() {
  return to_line(failure(nullptr, json_rpc::kParseError,
                         "parse error: too many lines in a row are no JSON; the connection is closed"));
}

std::string Dispatcher::too_many_connections() {
  return to_line(failure(nullptr, rpc_error(ErrorCode::kBusy).code, "too many connections; the connection is closed",
                         {{"error", "too_many_connections"}, {"retry", true}}));
}

}  // namespace fvd
