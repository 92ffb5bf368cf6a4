#include "daemon/api/replies.hpp"

#include <utility>

#include "daemon/api/params.hpp"
#include "daemon/api/rpc_errors.hpp"

namespace fvd {

using nlohmann::json;
using nlohmann::ordered_json;

std::string shortened_foreign_text(const std::string& text) {
  return text.size() > kMaxForeignText_bytes ? text.substr(0, kMaxForeignText_bytes - 3) + "..." : text;
}

std::string quoted(const std::string& text) { return "'" + shortened_foreign_text(text) + "'"; }

std::size_t envelope_bytes(const json& id) {
  const std::string around = reply_line(success_reply(id, ordered_json::object()));
  return around.size() - 1;  // the end of the line in place of {}
}

ordered_json success_reply(const json& id, ordered_json result) {
  return {{"jsonrpc", "2.0"}, {"id", id}, {"result", std::move(result)}};
}

ordered_json failure_reply(const json& id, int code, const std::string& message, ordered_json data) {
  if (data.is_null()) data = {{"error", json_rpc::name_of(code)}, {"retry", false}};
  ordered_json error{{"code", code}, {"message", message}, {"data", std::move(data)}};
  return {{"jsonrpc", "2.0"}, {"id", id}, {"error", std::move(error)}};
}

ordered_json failure_reply(const json& id, ErrorCode code, const std::string& message, std::string_view state) {
  const RpcError wire = rpc_error(code);
  ordered_json data{{"error", error_name(code)}, {"retry", wire.retry}};
  if (!state.empty()) data["state"] = state;
  return failure_reply(id, wire.code, message, std::move(data));
}

ordered_json failure_reply(const json& id, AccessCode code, const std::string& message) {
  const RpcError wire = rpc_error(code);
  return failure_reply(id, wire.code, message, {{"error", error_name(code)}, {"retry", wire.retry}});
}

std::string reply_line(const ordered_json& reply) {
  return reply.dump(-1, ' ', true, ordered_json::error_handler_t::replace);
}

bool is_valid_id(const json& id) {
  if (id.is_null()) return true;
  if (id.is_string()) return reply_line(id).size() <= kMaxForeignText_bytes + 2;
  return exact_integer(id).has_value();
}

}  // namespace fvd
