#pragma once

/// Whether clients could connect now, asked before anything is opened.

#include <optional>
#include <string>

namespace fvd {

/// Why nobody can listen on a numeric address and port of TCP now: another program has the port, no network card has
/// the address yet, or the system forbids it. Nothing if it can be. Keeps no port.
[[nodiscard]] std::optional<std::string> why_no_port(const std::string& address, int port);

}  // namespace fvd
