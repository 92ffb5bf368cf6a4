#pragma once

/// A TCP socket that listens on an IPv4 address.

#include <string>

namespace fvd::sim {

/// port: 0 = any free one. Returns a descriptor that the caller owns. Throws Error kBadConfig naming the address and
/// the reason if it cannot be bound.
[[nodiscard]] int listening_socket(const std::string& address, int port);
/// The port that such a socket has.
[[nodiscard]] int bound_port(int fd);

}  // namespace fvd::sim
