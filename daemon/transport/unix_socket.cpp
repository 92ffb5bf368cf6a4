#include "daemon/transport/unix_socket.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string>
#include <utility>

#include <fcntl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include "core/base/error.hpp"

namespace fvd {

namespace {

constexpr mode_t kEverybody = 0666;
constexpr char kBeingMade = '~';  // behind the name
constexpr std::size_t kGroupsAtFirst = 64;

[[noreturn]] void refuse(ErrorCode code, const std::filesystem::path& file, const std::string& why) {
  throw Error(code, "cannot listen on " + file.string() + ": " + why + "; see /rpc/socket and /paths/runtime_dir");
}

sockaddr_un address_of(const std::filesystem::path& file) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string text = file.string();
  if (text.empty() || text.size() > kLongestSocketPath) {
    refuse(ErrorCode::kBadConfig, file,
           "a socket's path has 1 to " + std::to_string(kLongestSocketPath) + " characters");
  }
  std::memcpy(address.sun_path, text.c_str(), text.size() + 1);
  return address;
}

UniqueFd new_socket(const std::filesystem::path& file) {
  UniqueFd fd(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  if (!fd.valid()) refuse(ErrorCode::kNotReady, file, std::strerror(errno));
  return fd;
}

/// Removes what a killed daemon left.
void clear_the_way(const std::filesystem::path& file, const sockaddr_un& address) {
  struct stat status {};
  if (::lstat(file.c_str(), &status) != 0) return;
  if (!S_ISSOCK(status.st_mode)) refuse(ErrorCode::kBadConfig, file, "something that is no socket is there");
  const UniqueFd probe = new_socket(file);
  // A backlog that is full says EAGAIN: somebody listens.
  const bool connected = ::connect(probe.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  if (connected || errno != ECONNREFUSED) refuse(ErrorCode::kNotReady, file, "another program listens there");
  if (::unlink(file.c_str()) != 0) refuse(ErrorCode::kStorageWrite, file, std::strerror(errno));
}

}  // namespace

UnixSocket::UnixSocket(std::filesystem::path file) : file_(std::move(file)) {
  const sockaddr_un address = address_of(file_);
  std::error_code ignored;
  std::filesystem::create_directories(file_.parent_path(), ignored);
  clear_the_way(file_, address);
  listener_ = new_socket(file_);
  // Under its own name it is there when it listens and everybody may connect, not before.
  const std::string made = file_.string() + kBeingMade;
  sockaddr_un made_address = address;
  std::memcpy(made_address.sun_path, made.c_str(), made.size() + 1);
  ::unlink(made.c_str());
  struct stat status {};
  if (::bind(listener_.get(), reinterpret_cast<const sockaddr*>(&made_address), sizeof made_address) != 0 ||
      ::chmod(made.c_str(), kEverybody) != 0 || ::lstat(made.c_str(), &status) != 0 ||
      ::listen(listener_.get(), SOMAXCONN) != 0 ||
      ::renameat2(AT_FDCWD, made.c_str(), AT_FDCWD, file_.c_str(), RENAME_NOREPLACE) != 0) {
    const int failure = errno;
    ::unlink(made.c_str());
    refuse(failure == EEXIST ? ErrorCode::kNotReady : ErrorCode::kStorageWrite, file_, std::strerror(failure));
  }
  device_ = status.st_dev;
  inode_ = status.st_ino;
}

UnixSocket::~UnixSocket() {
  struct stat status {};
  if (::lstat(file_.c_str(), &status) == 0 && status.st_dev == device_ && status.st_ino == inode_) {
    ::unlink(file_.c_str());
  }
}

LocalPeer local_peer_of(int fd) {
  LocalPeer peer{0, static_cast<uid_t>(-1), {}};
  ucred credentials{};
  socklen_t size = sizeof credentials;
  if (::getsockopt(fd, SOL_SOCKET, SO_PEERCRED, &credentials, &size) != 0) return peer;
  peer.pid = credentials.pid;
  peer.uid = credentials.uid;
  peer.groups.resize(kGroupsAtFirst);
  size = static_cast<socklen_t>(peer.groups.size() * sizeof(gid_t));
  int result = ::getsockopt(fd, SOL_SOCKET, SO_PEERGROUPS, peer.groups.data(), &size);
  if (result != 0 && errno == ERANGE) {  // size says now how many there are
    peer.groups.resize(size / sizeof(gid_t));
    result = ::getsockopt(fd, SOL_SOCKET, SO_PEERGROUPS, peer.groups.data(), &size);
  }
  peer.groups.resize(result == 0 ? size / sizeof(gid_t) : 0);
  peer.groups.push_back(credentials.gid);
  return peer;
}

}  // namespace fvd
