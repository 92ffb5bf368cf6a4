#include "sim/base/listening_socket.hpp"

#include <cerrno>
#include <cstdint>
#include <cstring>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "core/base/error.hpp"

namespace fvd::sim {

int listening_socket(const std::string& address, int port) {
  const int fd = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const int on = 1;
  ::setsockopt(fd, SOL_SOCKET, SO_REUSEADDR, &on, sizeof(on));
  sockaddr_in where{};
  where.sin_family = AF_INET;
  where.sin_port = htons(static_cast<std::uint16_t>(port));
  const bool bound = ::inet_pton(AF_INET, address.c_str(), &where.sin_addr) == 1 &&
                     ::bind(fd, reinterpret_cast<const sockaddr*>(&where), sizeof(where)) == 0 && ::listen(fd, 8) == 0;
  if (bound) return fd;
  const std::string reason = std::strerror(errno);
  ::close(fd);
  throw Error(ErrorCode::kBadConfig,
              "the simulated stage cannot listen on " + address + ":" + std::to_string(port) + ": " + reason);
}

int bound_port(int fd) {
  sockaddr_in where{};
  socklen_t length = sizeof(where);
  ::getsockname(fd, reinterpret_cast<sockaddr*>(&where), &length);
  return ntohs(where.sin_port);
}

}  // namespace fvd::sim
