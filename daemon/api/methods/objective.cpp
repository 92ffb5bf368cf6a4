/// Which objective is on the microscope.

#include <algorithm>

#include "daemon/api/methods/job_key_params.hpp"
#include "daemon/api/methods/methods.hpp"
#include "daemon/api/replies.hpp"
#include "daemon/api/result_fields.hpp"
#include "daemon/api/rpc_errors.hpp"

namespace fvd {

namespace {

constexpr std::size_t kMaxPerson_bytes = 64;

struct ConfirmParams {
  std::string name;
  std::string person;
  ClientParam client;

  void describe(Fields& fields) {
    fields.text("name", name, kMaxForeignText_bytes, "of the configuration's objectives");
    fields.require("name");
    fields.text("person", person, kMaxPerson_bytes, "who looked; empty = the client");
    client.describe(fields);
  }
};

void describe_confirmation(const ResultFields& result, Presence presence) {
  result.text("person", "who confirmed it", presence);
  result.text("confirmed_utc", "when", presence);
}

void describe_list(Fields& fields) {
  const ResultFields result(fields);
  result.any("objectives",
             "list of objects: name, na, magnification, working_distance_mm, and min_um, max_um where it has soft "
             "limits of z");
  result.text("objective", "that was confirmed; empty = none");
  describe_confirmation(result, Presence::kSometimes);
}

void describe_confirmed(Fields& fields) {
  const ResultFields result(fields);
  result.text("objective", "confirmed from now on, also after a restart");
  describe_confirmation(result, Presence::kAlways);
}

Reply objective_json(const ObjectiveConfig& objective) {
  Reply reply{{"name", objective.name},
              {"na", objective.na},
              {"magnification", objective.magnification},
              {"working_distance_mm", objective.working_distance_mm}};
  if (objective.min_um) reply["min_um"] = *objective.min_um;
  if (objective.max_um) reply["max_um"] = *objective.max_um;
  return reply;
}

Reply confirmation_json(const ObjectiveConfirmation& confirmed) {
  return {{"objective", confirmed.objective}, {"person", confirmed.person}, {"confirmed_utc", confirmed.confirmed_utc}};
}

Answer list(const ObjectiveService& objectives) {
  const ObjectiveService::Known known = objectives.known();
  Reply reply{{"objectives", Reply::array()}, {"objective", ""}};
  for (const ObjectiveConfig& objective : known.objectives) {
    reply["objectives"].push_back(objective_json(objective));
  }
  if (known.confirmed) reply.update(confirmation_json(*known.confirmed));
  return reply;
}

/// The person that is given, else the client that calls.
std::string checked_person(const ConfirmParams& params) {
  const std::string& client = params.client.checked();
  if (std::any_of(params.person.begin(), params.person.end(), [](unsigned char c) { return c < 0x20 || c == 0x7F; })) {
    throw ProtocolError{json_rpc::kInvalidParams, "person must have no control characters"};
  }
  return params.person.empty() ? client : params.person;
}

}  // namespace

void add_objective_methods(MethodTable& methods, const Services& services) {
  using enum ErrorCode;
  methods["objective.list"] = {
      .about = {.summary = "The objectives of the configuration, and the one that was confirmed",
                .role = Role::kView,
                .params = described<NoParams>(),
                .result = describe_list,
                .errors = {kDatabase}},
      .run = [&objectives = services.objectives](const Call&) { return list(objectives); }};
  methods["objective.confirm"] = {
      .about = {.summary = "Says which objective is on the microscope; jobs of recipes that name another are refused",
                .role = Role::kOperate,
                .params = described<ConfirmParams>(),
                .result = describe_confirmed,
                .errors = {kBadInput, kBusy, kShuttingDown, kStorageFull, kDatabase},
                .needs_control = true,
                .is_audited = true,
                .needs_id = true},
      .run =
          with<ConfirmParams>([&objectives = services.objectives](const Call&, const ConfirmParams& params) -> Answer {
            return confirmation_json(objectives.confirm(params.name, checked_person(params)));
          })};
}

}  // namespace fvd
