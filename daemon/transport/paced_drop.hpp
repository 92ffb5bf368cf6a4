#pragma once

/// What a refused client goes on sending is read and dropped: to close with unread input would discard what it was
/// told.

#include <array>
#include <chrono>
#include <cstddef>
#include <utility>

#include <boost/asio/buffer.hpp>
#include <boost/system/error_code.hpp>

namespace fvd {

// Dropped no faster than so: as fast as it comes would take the processor from others.
inline constexpr std::size_t kDropChunk_bytes = std::size_t{64} << 10U;
inline constexpr std::chrono::milliseconds kDropPause{10};

/// Drops what comes until nothing can, then calls done(), which keeps socket and timer alive; without that call once
/// the timer is cancelled. context: one thread for all sockets, as of an io_context.
template <typename Socket, typename Timer, typename Done>
void drop_at_a_pace(Socket& socket, Timer& pause, Done done) {
  pause.expires_after(kDropPause);
  pause.async_wait([&socket, &pause, done = std::move(done)](boost::system::error_code stopped) mutable {
    if (stopped) return;
    thread_local std::array<char, kDropChunk_bytes> dropped;  // of all sockets: nobody looks at it
    socket.async_read_some(boost::asio::buffer(dropped), [&socket, &pause, done = std::move(done)](
                                                             boost::system::error_code error, std::size_t) mutable {
      if (error) return done();
      drop_at_a_pace(socket, pause, std::move(done));
    });
  });
}

}  // namespace fvd
