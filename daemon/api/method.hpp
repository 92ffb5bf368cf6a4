#pragma once

/// What a method of the API is: its description, and how it is answered.

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/error.hpp"
#include "daemon/api/call.hpp"
#include "daemon/api/params.hpp"

namespace fvd {

/// From it follow the check of the parameters, rpc.discover and the tables of daemon/README.md.
struct MethodDescription {
  std::string summary;
  Role role = Role::kAdminister;    ///< the least that may call it
  DescribeFields params;            ///< on values of its own, at their defaults
  DescribeFields result;            ///< likewise; every key is required unless it is optional
  std::vector<ErrorCode> errors{};  ///< beside those of JSON-RPC and kInternal
  bool moves_stage = false;         ///< the part is not free while it runs
  bool may_wait = false;            ///< the reply may come later; in a batch it comes at once or not
  bool needs_control = false;       ///< refused while another has control of the instrument
  /// Overtakes what the same connection asked for before, if peek answers it: nothing holds a stop back.
  bool is_urgent = false;
  bool is_log_in = false;   ///< says who the caller is: waits for no other call
  bool is_long = false;     ///< reads much for people: no call that a line waits for waits for it
  bool is_audited = false;  ///< who asked for it is written down
  /// Every reply has a form of at most kCompactReply_bytes, and every error reply has: a PLC polls it.
  bool is_brief = false;
  bool needs_id = false;  ///< refused as a notification: somebody has to know what became of it
};

/// context: peek and run on any thread.
struct Method {
  MethodDescription about;
  /// Answers from the machine's snapshot alone: no file, no database, no lock that is held across either. Nothing if
  /// that does not suffice and run has to answer.
  std::function<std::optional<Answer>(const Call&)> peek{};
  /// May block for files, the database and the devices' state. Throws Error, ProtocolError.
  std::function<Answer(const Call&)> run{};
};

using MethodTable = std::map<std::string, Method>;

/// For methods without parameters.
struct NoParams {
  void describe(Fields& /*fields*/) {}
};

/// The description of a structure of parameters, which describes itself: void Params::describe(Fields&).
template <typename Params>
[[nodiscard]] DescribeFields described() {
  return [](Fields& fields) { Params{}.describe(fields); };
}

template <typename Params>
[[nodiscard]] Params params_of(const Call& call) {
  Params params;
  read_params(call.params, [&params](Fields& fields) { params.describe(fields); });
  return params;
}

/// Has a function of a structure of parameters answer a call: handler(call, params).
template <typename Params, typename Handler>
[[nodiscard]] auto with(Handler handler) {
  return [handler = std::move(handler)](const Call& call) { return handler(call, params_of<Params>(call)); };
}

}  // namespace fvd
