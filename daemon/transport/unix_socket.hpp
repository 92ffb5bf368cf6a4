#pragma once

/// The unix socket: its file, and who is at the other end.

#include <filesystem>

#include <sys/types.h>
#include <sys/un.h>

#include "daemon/access/access_rules.hpp"
#include "daemon/base/unique_fd.hpp"

namespace fvd {

/// One less than a socket's address can hold: while it is made its name is longer.
inline constexpr std::size_t kLongestSocketPath = sizeof sockaddr_un::sun_path - 2;

/// A listening socket with a file that everybody may connect to: who may do what is decided by the peer's credentials.
class UnixSocket {
 public:
  /// Makes the folder; the file appears once everybody may connect. A file that a killed daemon left is replaced.
  /// Throws Error kNotReady if a living program listens there, kBadConfig if the path is something else or too long,
  /// kStorageWrite.
  explicit UnixSocket(std::filesystem::path file);
  /// Removes the file, unless another program has put its own there.
  ~UnixSocket();
  UnixSocket(const UnixSocket&) = delete;
  UnixSocket& operator=(const UnixSocket&) = delete;

  [[nodiscard]] const std::filesystem::path& file() const noexcept { return file_; }
  /// The descriptor, once: whoever takes it closes it.
  [[nodiscard]] int take_listener() noexcept { return listener_.release(); }

 private:
  std::filesystem::path file_;
  UniqueFd listener_;
  dev_t device_ = 0;
  ino_t inode_ = 0;
};

/// The process at the other end, as it was when it connected: SO_PEERCRED, SO_PEERGROUPS. Nobody, as uid -1, if the
/// system does not tell.
[[nodiscard]] LocalPeer local_peer_of(int fd);

}  // namespace fvd
