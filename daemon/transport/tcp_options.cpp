#include "daemon/transport/tcp_options.hpp"

#include <array>

#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

namespace fvd {

namespace {

constexpr int kUnacknowledged_ms = 15000;  // README.md, THREATS.md and http_resource.hpp tell it

}  // namespace

void tune(int fd) noexcept {
  const auto set = [fd](int level, int option, int value) { ::setsockopt(fd, level, option, &value, sizeof(value)); };
  set(IPPROTO_TCP, TCP_NODELAY, 1);
  set(SOL_SOCKET, SO_KEEPALIVE, 1);
  set(IPPROTO_TCP, TCP_KEEPIDLE, 10);
  set(IPPROTO_TCP, TCP_KEEPINTVL, 5);
  set(IPPROTO_TCP, TCP_KEEPCNT, 3);
  set(IPPROTO_TCP, TCP_USER_TIMEOUT, kUnacknowledged_ms);
}

std::string peer_of(int fd) {
  sockaddr_storage address{};
  socklen_t size = sizeof(address);
  std::array<char, NI_MAXHOST> host{};
  std::array<char, NI_MAXSERV> port{};
  auto* any = reinterpret_cast<sockaddr*>(&address);
  if (::getpeername(fd, any, &size) != 0 || ::getnameinfo(any, size, host.data(), host.size(), port.data(), port.size(),
                                                          NI_NUMERICHOST | NI_NUMERICSERV) != 0) {
    return "";
  }
  const std::string name(host.data());
  return (address.ss_family == AF_INET6 ? "[" + name + "]" : name) + ":" + port.data();
}

}  // namespace fvd
