#pragma once

/// One call over HTTP: a text out, the answer's text in.

#include <chrono>
#include <string>
#include <string_view>

#include "daemon/ctl/line_socket.hpp"

namespace fvd::ctl {

/// Posts the body to /api/jsonrpc on a connection that is kept. token: who calls; empty = nobody says. The body of the
/// answer; empty for one without a body. Throws Error as LineSocket does; RpcError of code 1004 for status 401
/// and 403, Error kNotReady for another answer that is no success of HTTP, with what the server says; kBadInput for one
/// that is no HTTP.
[[nodiscard]] std::string http_exchange(LineSocket& socket, std::string_view body, const std::string& token,
                                        std::chrono::milliseconds timeout);

}  // namespace fvd::ctl
