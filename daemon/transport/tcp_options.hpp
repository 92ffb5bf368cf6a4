#pragma once

/// What this program does with a TCP socket beyond reading and writing.

#include <string>

namespace fvd {

/// No delay of small segments; a silent peer is asked after 10 s, then every 5 s, and given up after 3 questions or
/// when sent data is not acknowledged for 15 s. fd: a TCP socket.
void tune(int fd) noexcept;

/// Address and port of the other end, "10.0.0.7:40312" or "[::1]:40312"; empty if it is gone.
[[nodiscard]] std::string peer_of(int fd);

}  // namespace fvd
