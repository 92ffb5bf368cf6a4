#pragma once

/// Options of a TCP socket, and the address of its other end.

#include <string>

namespace fvd {

/// Disables the delay of small segments (TCP_NODELAY). Probes a silent peer after 10 s, then every 5 s; closes the
/// connection after 3 probes without an answer, or if sent data is not acknowledged for 15 s. fd: a TCP socket.
void tune(int fd) noexcept;

/// Address and port of the other end, "10.0.0.7:40312" or "[::1]:40312"; empty if it is gone.
[[nodiscard]] std::string peer_of(int fd);

}  // namespace fvd
