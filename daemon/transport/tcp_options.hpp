#pragma once

/// How a connection is kept: small replies leave at once, a peer that is gone is noticed.

namespace fvd {

/// No delay of small segments; a silent peer is asked after 10 s, then every 5 s, and given up after 3 questions or
/// when sent data is not acknowledged for 15 s. fd: a TCP socket.
void tune(int fd) noexcept;

}  // namespace fvd
