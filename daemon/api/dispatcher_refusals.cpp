/// What a connection is told before it is closed: lines that no request of it asked for.

#include <string>

#include "daemon/api/dispatcher.hpp"
#include "daemon/api/replies.hpp"
#include "daemon/api/rpc_errors.hpp"

namespace fvd {

std::string Dispatcher::too_long() {
  return reply_line(
      failure_reply(nullptr, json_rpc::kInvalidRequest,
                    "the line is longer than " + std::to_string(kMaxLineBytes) + " bytes; the connection is closed"));
}

std::string Dispatcher::foreign_protocol() {
  return reply_line(
      failure_reply(nullptr, json_rpc::kInvalidRequest,
                    "this port takes JSON-RPC, one JSON text a line, no HTTP and no TLS; the connection is closed"));
}

std::string Dispatcher::mistaken(std::string_view mistake) {
  return reply_line(failure_reply(nullptr, json_rpc::kParseError, std::string(mistake) + "; the connection is closed"));
}

std::string Dispatcher::no_json() {
  return reply_line(failure_reply(nullptr, json_rpc::kParseError,
                                  "parse error: too many lines in a row are no JSON; the connection is closed"));
}

std::string Dispatcher::not_allowed_here() {
  return reply_line(
      failure_reply(nullptr, AccessCode::kNotAllowed,
                    "from here nobody may do anything: see rpc.allow and rpc.groups in the configuration; "
                    "the connection is closed"));
}

std::string Dispatcher::too_many_connections() {
  return reply_line(failure_reply(nullptr, rpc_error(ErrorCode::kBusy).code,
                                  "too many connections; the connection is closed",
                                  {{"error", "too_many_connections"}, {"retry", true}}));
}

}  // namespace fvd
