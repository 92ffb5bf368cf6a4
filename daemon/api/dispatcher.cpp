#include "daemon/api/dispatcher.hpp"

#include <algorithm>
#include <utility>

#include <spdlog/spdlog.h>

#include "config/strict_json.hpp"
#include "daemon/api/access.hpp"
#include "daemon/api/json_shapes.hpp"
#include "daemon/api/replies.hpp"
#include "daemon/api/reply_size.hpp"
#include "daemon/api/rpc_errors.hpp"
#include "daemon/base/log_scope.hpp"

namespace fvd {

namespace {

using nlohmann::json;
using nlohmann::ordered_json;

constexpr std::size_t kLongestDetail_bytes = 240;  // of a row of the audit
/// Members of a batch that is too large, each of which is refused by its id. A refusal is ten times as long as what it
/// refuses.
constexpr std::size_t kMostRefusedSingly = 1024;

bool has_come(const JobStatus& job, bool until_acquired) {
  return job.state != JobState::kProcessing || (until_acquired && job.acquired);
}

/// The request's id if it is valid, whatever else is wrong with the request; otherwise null.
json usable_id(const json& request) {
  if (!request.is_object()) return nullptr;
  const auto id = request.find("id");
  return id != request.end() && is_valid_id(*id) ? *id : json(nullptr);
}

/// Describes the first fault in the form of a request; nothing if the form is right.
std::optional<std::string> fault_of(const json& request) {
  if (!request.is_object()) return "a request is an object";
  if (const auto id = request.find("id"); id != request.end() && !is_valid_id(*id)) {
    return "id must be null, a text of at most 64 bytes as JSON writes it, or an integer of at most 2^53-1";
  }
  const auto version = request.find("jsonrpc");
  if (version == request.end() || *version != "2.0") return "jsonrpc must be \"2.0\"";
  const auto method = request.find("method");
  if (method == request.end() || !method->is_string()) return "method must be a text";
  const auto params = request.find("params");
  if (params != request.end() && !params->is_structured() && !params->is_null()) {
    return "params must be an object or a list";
  }
  return std::nullopt;
}

/// Shortens the part of the parser's message that quotes the input; the words before the quote are the parser's own.
std::string shortened_parse_error(const std::string& message) {
  const auto quote = message.find('\'');
  if (quote == std::string::npos) return message;
  return message.substr(0, quote) + shortened_foreign_text(message.substr(quote));
}

/// The reason why a batch is refused as a whole; nothing if its members are executed.
std::optional<std::string> fault_of_batch(const json& batch) {
  if (batch.size() > Dispatcher::kMaxBatch) {
    return "a batch may hold " + std::to_string(Dispatcher::kMaxBatch) + " requests";
  }
  const auto starts = std::count_if(batch.begin(), batch.end(), [](const json& request) {
    return request.is_object() && request.contains("method") && request["method"] == "job.start";
  });
  if (starts > 1) return "a batch may start one job";
  return std::nullopt;
}

/// One refusal per member with an id, and one with a null id for all other members that are no notifications.
ordered_json refuse_batch(const json& batch, const std::string& why) {
  ordered_json replies = ordered_json::array();
  bool told_the_nameless = false;
  for (const json& request : batch) {
    const json id = usable_id(request);
    const bool is_notification = request.is_object() && !request.contains("id") && !fault_of(request);
    if (is_notification || (id.is_null() && std::exchange(told_the_nameless, true))) continue;
    replies.push_back(failure_reply(id, json_rpc::kInvalidRequest, why));
  }
  return replies;
}

}  // namespace

Dispatcher::Dispatcher(MethodTable methods, const Services& services)
    : services_(services), methods_(std::move(methods)) {}

Handled Dispatcher::handle(std::string_view line, const Caller& caller) const {
  return handle_line(line, caller, true).value_or(Handled{});
}

std::optional<Handled> Dispatcher::try_handle(std::string_view line, const Caller& caller) const {
  return handle_line(line, caller, false);
}

std::optional<Handled> Dispatcher::handle_line(std::string_view line, const Caller& caller, bool may_block) const {
  Problems problems;
  const auto document = parse_strict_json(line, problems, JsonComments::kRefused);
  if (!document) {
    const std::string why = "parse error: " + shortened_parse_error(problems.front().message);
    ordered_json refusal = failure_reply(nullptr, json_rpc::kParseError, why);
    fit_error(refusal);
    return Handled{.reply = reply_line(refusal), .is_parse_error = true};
  }
  Outcome answer = document->is_array() ? handle_batch(*document, caller, may_block)
                                        : handle_request(*document, caller, {may_block, false});
  if (answer.would_block) return std::nullopt;
  Handled handled;
  if (answer.reply) handled.reply = line_within(std::move(*answer.reply), caller.longest_reply_bytes);
  handled.waiting = std::move(answer.waiting);
  handled.log_in = std::move(answer.log_in);
  handled.is_accepted = answer.is_accepted;
  return handled;
}

const Method* Dispatcher::overtaker(std::string_view line) const {
  const Method* method = method_of(line);
  return method != nullptr && method->peek ? method : nullptr;
}

bool Dispatcher::may_overtake(const Method& method, const Caller& caller, Behind behind) {
  if (behind == Behind::kWork && !method.about.is_urgent) return false;
  // Who may not yet may log in with a line before it: then it keeps its turn.
  return may_call(caller, method.about);
}

std::string Dispatcher::job_on_board() const {
  const auto snapshot = services_.machine.snapshot();
  return snapshot->job ? snapshot->job->job_id : std::string();
}

bool Dispatcher::is_log_in(std::string_view line) const {
  const Method* method = method_of(line);
  return method != nullptr && method->about.is_log_in;
}

bool Dispatcher::is_long(std::string_view line) const {
  Problems ignored;  // told when the line is handled
  const auto document = parse_strict_json(line, ignored, JsonComments::kRefused);
  if (!document) return false;
  const auto is_one = [this](const json& request) {
    const Method* method = method_in(request);
    return method != nullptr && method->about.is_long;
  };
  return document->is_array() ? std::any_of(document->begin(), document->end(), is_one) : is_one(*document);
}

const Method* Dispatcher::method_of(std::string_view line) const {
  Problems ignored;  // told when its turn comes
  const auto document = parse_strict_json(line, ignored, JsonComments::kRefused);
  return document ? method_in(*document) : nullptr;
}

const Method* Dispatcher::method_in(const json& request) const {
  if (!request.is_object()) return nullptr;
  const auto name = request.find("method");
  if (name == request.end() || !name->is_string()) return nullptr;
  const auto method = methods_.find(name->get<std::string>());
  return method == methods_.end() ? nullptr : &method->second;
}

Dispatcher::Outcome Dispatcher::handle_batch(const json& batch, const Caller& caller, bool may_block) const {
  if (batch.empty()) return {failure_reply(nullptr, json_rpc::kInvalidRequest, "an empty batch")};
  if (batch.size() > kMostRefusedSingly) {
    return {ordered_json::array({failure_reply(nullptr, json_rpc::kInvalidRequest, *fault_of_batch(batch))})};
  }
  ordered_json replies = ordered_json::array();
  bool accepted = false;
  if (const auto fault = fault_of_batch(batch)) {
    replies = refuse_batch(batch, *fault);
  } else {
    for (const json& request : batch) {
      // The members before this one were answered from the snapshot: handling the batch again repeats nothing.
      Outcome answer = handle_request(request, caller, {may_block, true});
      if (answer.would_block) return answer;
      accepted = accepted || answer.is_accepted;
      if (answer.reply) replies.push_back(std::move(*answer.reply));
    }
  }
  Outcome outcome{.is_accepted = accepted};
  if (!replies.empty()) outcome.reply = std::move(replies);
  return outcome;
}

bool Dispatcher::is_brief(const json& request) const {
  const auto method = methods_.find(request["method"].get_ref<const std::string&>());
  return method == methods_.end() || method->second.about.is_brief;
}

Dispatcher::Outcome Dispatcher::handle_request(const json& request, const Caller& caller, Mode mode) const {
  const json id = usable_id(request);
  if (const auto fault = fault_of(request)) return {failure_reply(id, json_rpc::kInvalidRequest, *fault)};
  const bool is_notification = !request.contains("id");
  Outcome answer;
  try {
    run_method(request, id, caller, mode, answer);
  } catch (const ProtocolError& error) {
    answer.reply = failure_reply(id, error.code, error.message, error.data);
  } catch (const AccessError& error) {
    answer.reply = failure_reply(id, error.code(), error.what());
  } catch (const Error& error) {
    answer.reply = failure_reply(id, error.code(), error.what(), scan_state_name(services_.machine.snapshot()->state));
  } catch (const std::exception& error) {
    answer.reply = failure_reply(id, json_rpc::kInternalError, std::string("internal error: ") + error.what(),
                                 {{"error", "internal"}});
  }
  if (is_notification) answer.reply.reset();
  if (answer.reply && answer.reply->contains("error") && is_brief(request)) fit_error(*answer.reply);
  return answer;
}

void Dispatcher::run_method(const json& request, const json& id, Caller caller, Mode mode, Outcome& outcome) const {
  const auto& name = request["method"].get_ref<const std::string&>();
  const auto found = methods_.find(name);
  if (found == methods_.end()) {
    throw ProtocolError{json_rpc::kMethodNotFound, "there is no method " + quoted(name) + "; rpc.discover lists them"};
  }
  const Method& method = found->second;
  const bool is_notification = !request.contains("id");
  if (!may_call(caller, method.about)) {
    const AccessError error(AccessCode::kNotAllowed,
                            name + " needs the role " + std::string(role_name(method.about.role)) +
                                ", this caller has " + std::string(role_name(caller.who.role)) +
                                "; a token gives another: session.login, by HTTP Authorization: Bearer");
    note_refusal(method, {caller, name, request.value("params", json())}, error);
    throw error;
  }
  if (method.about.needs_id && is_notification) {
    warn_of(caller, "a " + name + " without an id was refused to " + text_of(caller) +
                        ": it could not be told what became of it");
    throw ProtocolError{json_rpc::kInvalidRequest, name + " needs an id"};
  }
  if (mode.in_batch && method.about.is_urgent) {
    throw ProtocolError{json_rpc::kInvalidRequest, name + " is for a request of its own, which nothing holds back"};
  }
  const auto given = request.find("params");
  const json params = checked_params(name, method.about.params, given == request.end() ? json(nullptr) : *given);
  if (const auto client = params.find("client"); client != params.end()) {
    // A name that is none is refused by the method; until then it stands in no log.
    if (auto given_name = client->get<std::string>(); is_client_name(given_name)) caller.name = std::move(given_name);
  }
  const LogScope scope({.caller = caller.name});
  // Whoever has no role is accepted once he has said who he is.
  outcome.is_accepted = method.about.role > Role::kNone;
  auto answer =
      answer_of(method, {caller, name, params, !mode.in_batch && !is_notification, envelope_bytes(id)}, mode.may_block);
  if (!answer) {
    outcome.would_block = true;
  } else if (auto* deferred = std::get_if<Deferred>(&*answer)) {
    outcome.waiting = WaitingRequest{id, std::move(*deferred)};
  } else if (auto* log_in = std::get_if<LogIn>(&*answer)) {
    outcome.is_accepted = true;
    outcome.log_in = std::move(log_in->who);
    outcome.reply = success_reply(id, std::move(log_in->reply));
  } else {
    outcome.reply = success_reply(id, std::get<Reply>(std::move(*answer)));
  }
}

std::optional<Answer> Dispatcher::answer_of(const Method& method, const Call& call, bool may_block) const {
  const MethodDescription& about = method.about;
  try {
    if (about.needs_control) services_.control.require(call.caller.who.name);
    if (method.peek) {
      if (auto answer = method.peek(call)) {
        if (about.is_urgent) note(method, call, "ok");
        return answer;
      }
    }
    if (!may_block) return std::nullopt;
    if (about.moves_stage && call.caller.received != HostTime{} && services_.jobs.stopped_since(call.caller.received)) {
      throw Error(ErrorCode::kAborted, call.method + " waited, and stage.stop came meanwhile; nothing was moved");
    }
    auto answer = method.run(call);
    const auto* const later = std::get_if<Deferred>(&answer);
    const auto* const task = later != nullptr ? std::get_if<std::shared_ptr<DeviceTask>>(&later->awaited) : nullptr;
    note(method, call, task != nullptr ? "accepted" : "ok");
    if (task != nullptr && method.about.is_audited) note_outcome_of(**task, call);
    return answer;
  } catch (const AccessError& error) {
    note_refusal(method, call, error);
    throw;
  } catch (const Error& error) {
    if (about.needs_id) {
      const auto* const tokens = dynamic_cast<const TokensUnreadable*>(&error);
      warn_of(call.caller,
              call.method + " was refused to " + text_of(call.caller) + ": " + std::string(error_name(error.code())) +
                  ": " + error.what(),
              tokens != nullptr ? tokens->reason() : std::string());
    }
    note(method, call, error_name(error.code()));
    throw;
  }
}

void Dispatcher::note(const Method& method, const Call& call, std::string_view outcome) const {
  const MethodDescription& about = method.about;
  if ((outcome == "ok" || outcome == "accepted") && (about.needs_id || about.is_audited)) {
    spdlog::info("{} for {}", call.method, text_of(call.caller));
  }
  if (about.is_audited) services_.audit.note(audit_entry(call, outcome));
}

void Dispatcher::note_outcome_of(DeviceTask& task, const Call& call) const {
  // A row of its own: by then the caller, and who he was, may have changed.
  task.note_outcome([entry = audit_entry(call, {}), &audit = services_.audit](const DeviceTask::Outcome& outcome) {
    AuditEntry ended = entry;
    ended.is_end = true;
    ended.outcome = outcome.error ? std::string(error_name(*outcome.error)) : "ok";
    audit.note(std::move(ended));
  });
}

AuditEntry Dispatcher::audit_entry(const Call& call, std::string_view outcome) {
  json params = call.params;
  if (params.contains("text")) params["text"] = "...";  // a whole document
  std::string detail = params.dump(-1, ' ', true, json::error_handler_t::replace);
  if (detail.size() > kLongestDetail_bytes) detail = detail.substr(0, kLongestDetail_bytes - 3) + "...";
  const Caller& caller = call.caller;
  return {0,
          {},
          caller.who.name,
          std::string(role_name(caller.who.role)),
          caller.peer,
          caller.name,
          call.method,
          std::move(detail),
          std::string(outcome)};
}

void Dispatcher::note_refusal(const Method& method, const Call& call, const AccessError& error) const {
  warn_of(call.caller, call.method + " was refused to " + text_of(call.caller) + ": " + error.what());
  if (call.caller.who.role > Role::kNone) note(method, call, error_name(error.code()));
}

bool Dispatcher::may_have_come(const WaitingRequest& waiting) const {
  if (const auto* task = std::get_if<std::shared_ptr<DeviceTask>>(&waiting.until.awaited)) {
    return (*task)->outcome().has_value();
  }
  const auto& wait = std::get<JobWait>(waiting.until.awaited);
  const auto snapshot = services_.machine.snapshot();
  const bool is_there = snapshot->job && snapshot->job->job_id == wait.job_id;
  return !is_there || has_come(*snapshot->job, wait.until_acquired);
}

std::optional<std::string> Dispatcher::resume(const WaitingRequest& waiting, bool timed_out) const {
  const auto refused = [&](ErrorCode code, const std::string& message) {
    const auto state = scan_state_name(services_.machine.snapshot()->state);
    ordered_json reply = failure_reply(waiting.id, code, message, state);
    if (std::holds_alternative<JobWait>(waiting.until.awaited)) fit_error(reply);
    return reply_line(reply);
  };
  try {
    if (const auto* task = std::get_if<std::shared_ptr<DeviceTask>>(&waiting.until.awaited)) {
      const auto outcome = (*task)->outcome();
      if (!outcome && !timed_out) return std::nullopt;
      if (!outcome) throw Error(ErrorCode::kTimeout, "the command is not done in 5 minutes");
      if (outcome->error) throw Error(*outcome->error, outcome->message);
      return reply_line(success_reply(waiting.id, ordered_json::parse(outcome->json)));
    }
    const auto& wait = std::get<JobWait>(waiting.until.awaited);
    const JobStatus job = services_.jobs.job(wait.job_id);
    if (!timed_out && !has_come(job, wait.until_acquired)) return std::nullopt;
    return reply_line(success_reply(waiting.id, job_status_reply(job, wait.form, envelope_bytes(waiting.id))));
  } catch (const Error& error) {
    return refused(error.code(), error.what());
  } catch (const std::exception& error) {
    return refused(ErrorCode::kInternal, error.what());
  }
}

std::string Dispatcher::ended(const WaitingRequest& waiting) const {
  const bool is_job = std::holds_alternative<JobWait>(waiting.until.awaited);
  return reply_line(failure_reply(waiting.id, ErrorCode::kShuttingDown,
                                  is_job ? "the daemon stops; what was waited for is told when it is back"
                                         : "the daemon stops, and the command with it; ask for system.state when it is "
                                           "back, and then for the command again if it is still to be done",
                                  scan_state_name(services_.machine.snapshot()->state)));
}

}  // namespace fvd
