/// Who the caller is, who has control, who asked for what.

#include <algorithm>
#include <chrono>
#include <cmath>

#include "daemon/access/access_error.hpp"
#include "daemon/api/methods/device_task.hpp"
#include "daemon/api/methods/methods.hpp"
#include "daemon/api/replies.hpp"
#include "daemon/api/result_fields.hpp"
#include "daemon/api/rpc_errors.hpp"

namespace fvd {

namespace {

constexpr std::size_t kLongestToken_bytes = 256;

struct LoginParams {
  std::string token;

  void describe(Fields& fields) {
    fields.text("token", token, kLongestToken_bytes, "as fvdctl token new printed it");
    fields.require("token");
  }
};

struct AcquireParams {
  std::string owner;
  std::int64_t lease_s = 60;
  bool force = false;

  void describe(Fields& fields) {
    fields.text("owner", owner, kLongestClientName_bytes, "who you are, for people: letters, digits, '.', '_', '-'");
    fields.require("owner");
    fields.integer64("lease_s", lease_s, {1, 3600}, "then control ends by itself, unless it is acquired anew before");
    fields.boolean("force", force, "take it from another; only for who administers, never while a job runs");
  }
};

struct ListParams {
  int most = 100;
  std::int64_t before = 0;

  void describe(Fields& fields) {
    fields.integer("most", most, {1, 1000}, "so many of the newest");
    fields.integer64("before", before, {0, kLargestExactInteger}, "only rows with a smaller number; 0 = all");
  }
};

void describe_identity(Fields& fields) {
  const ResultFields result(fields);
  result.text("who", "as whom this connection is recognised");
  result.text("role", "none, view, operate, set_up, administer");
}

void describe_control(Fields& fields) {
  const ResultFields result(fields);
  result.text("owner", "who has control, as he calls himself; empty = nobody");
  result.text("who", "as whom he was recognised; empty = nobody");
  result.number("remaining_s", "until it ends by itself; 0: nobody has it, or a job still runs, and it ends with that");
  result.boolean("yours", "the caller has it, by this or by another connection that is recognised as the same");
}

void describe_audit(Fields& fields) {
  ResultFields(fields).any(
      "entries",
      "list, the newest first: number, time_utc, who, role, peer, client, what, detail (parameters, "
      "shortened; of many refusals how many), outcome (ok, accepted: a row with its end follows, or an error's "
      "name)");
}

Reply identity_json(const Identity& who) { return {{"who", who.name}, {"role", role_name(who.role)}}; }

Reply control_json(const std::optional<ControlLease::Holder>& holder, const Caller& caller) {
  if (!holder) return {{"owner", ""}, {"who", ""}, {"remaining_s", 0}, {"yours", false}};
  const auto left = std::chrono::duration<double>(holder->until - HostClock::now()).count();
  return {{"owner", holder->owner},
          {"who", holder->who},
          {"remaining_s", std::round(std::max(0.0, left) * 1000) / 1000},
          {"yours", holder->who == caller.who.name}};
}

Answer log_in(const AccessRules& access, const Call& call, const LoginParams& params) {
  if (!call.may_wait) throw ProtocolError{json_rpc::kInvalidRequest, call.method + " is for a request of its own"};
  auto who = access.of_token(params.token);
  if (!who) throw AccessError(AccessCode::kNotAllowed, "nobody has this token; fvdctl token new makes one");
  Reply reply = identity_json(*who);
  return LogIn{*std::move(who), std::move(reply)};
}

Answer acquire(ControlLease& control, const Call& call, const AcquireParams& params) {
  if (!is_client_name(params.owner)) {
    throw ProtocolError{json_rpc::kInvalidParams, "owner must have 1 to 32 letters, digits, '.', '_', '-'"};
  }
  const auto holder =
      control.acquire({call.caller.who, params.owner, std::chrono::seconds(params.lease_s), params.force});
  return control_json(holder, call.caller);
}

Answer list(AuditService& audit, const ListParams& params) {
  Reply reply{{"entries", Reply::array()}};
  for (const AuditEntry& entry : audit.newest(params.most, params.before)) {
    reply["entries"].push_back({{"number", entry.number},
                                {"time_utc", entry.time_utc},
                                {"who", entry.who},
                                {"role", entry.role},
                                {"peer", entry.peer},
                                {"client", entry.client},
                                {"what", entry.what},
                                {"detail", entry.detail},
                                {"outcome", entry.outcome}});
  }
  return reply;
}

void add_control_methods(MethodTable& methods, ControlLease& control) {
  methods["control.acquire"] = {
      .about = {.summary = "Takes or renews control: from then on nobody else starts, moves or prepares",
                .role = Role::kOperate,
                .params = described<AcquireParams>(),
                .result = describe_control,
                .errors = {ErrorCode::kBusy},
                .is_audited = true,
                .needs_id = true},
      .run = with<AcquireParams>(
          [&control](const Call& call, const AcquireParams& params) { return acquire(control, call, params); })};
  methods["control.release"] = {.about = {.summary = "Gives control up; no effect for who has it not",
                                          .role = Role::kOperate,
                                          .params = described<NoParams>(),
                                          .result = describe_control,
                                          .is_audited = true},
                                .run = [&control](const Call& call) -> Answer {
                                  control.release(call.caller.who.name);
                                  return control_json(control.holder(), call.caller);
                                }};
  methods["control.state"] = {.about = {.summary = "Who has control",
                                        .role = Role::kView,
                                        .params = described<NoParams>(),
                                        .result = describe_control},
                              .peek = [&control](const Call& call) -> std::optional<Answer> {
                                return control_json(control.holder(), call.caller);
                              }};
}

}  // namespace

void add_access_methods(MethodTable& methods, const Services& services) {
  add_control_methods(methods, services.control);
  methods["session.login"] = {
      .about = {.summary = "Says by a token who the caller is, for this connection",
                .role = Role::kNone,
                .params = described<LoginParams>(),
                .result = describe_identity,
                .errors = {ErrorCode::kBadConfig},
                .is_log_in = true,
                .needs_id = true},
      .run = with<LoginParams>([&access = services.access](const Call& call, const LoginParams& params) {
        return log_in(access, call, params);
      })};
  methods["session.info"] = {
      .about = {.summary = "As whom the caller is recognised",
                .role = Role::kNone,
                .params = described<NoParams>(),
                .result = describe_identity},
      .peek = [](const Call& call) -> std::optional<Answer> { return identity_json(call.caller.who); }};
  methods["audit.list"] = {
      .about = {.summary = "Who asked for what: starts, moves, stops, changes of recipes and constants, loads of the "
                           "configuration",
                .role = Role::kView,
                .params = described<ListParams>(),
                .result = describe_audit,
                .errors = {ErrorCode::kDatabase},
                .is_long = true},  // it waits for rows that are being written, too
      .run = with<ListParams>(
          [&audit = services.audit](const Call&, const ListParams& params) { return list(audit, params); })};
}

}  // namespace fvd
