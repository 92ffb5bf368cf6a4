#pragma once

/// Whether clients could connect now, asked before anything is opened.

#include <optional>
#include <string>

#include "daemon/config/config.hpp"

namespace fvd {

/// Why nobody can listen on the configured address and port now: another program has the port, no network card has the
/// address yet, or the system forbids it. Nothing if it can be. Keeps no port.
[[nodiscard]] std::optional<std::string> why_no_port(const RpcConfig& rpc);

}  // namespace fvd
