#pragma once

/// What the descriptions of the methods say, for programs (OpenRPC) and for people (tables of daemon/README.md).

#include <string>

#include <nlohmann/json.hpp>

#include "daemon/api/method.hpp"

namespace fvd {

/// OpenRPC 1.2.6. Beyond it, of every method: x-role, x-moves-stage, x-may-wait, x-needs-control, x-urgent,
/// x-audited, x-needs-id.
[[nodiscard]] nlohmann::ordered_json openrpc_document(const MethodTable& methods);

/// Tables of the methods, of their parameters, and of the error codes, in Markdown.
[[nodiscard]] std::string methods_markdown(const MethodTable& methods);

}  // namespace fvd
