#include "daemon/port_probe.hpp"

#include <cerrno>
#include <cstring>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include "daemon/base/unique_fd.hpp"

namespace fvd {

namespace {

/// The port's number in network order is at one place in both kinds of addresses.
socklen_t fill(const std::string& address, int port, sockaddr_storage& storage) {
  sockaddr_in ipv4{};
  if (inet_pton(AF_INET, address.c_str(), &ipv4.sin_addr) == 1) {
    ipv4.sin_family = AF_INET;
    ipv4.sin_port = htons(static_cast<std::uint16_t>(port));
    std::memcpy(&storage, &ipv4, sizeof ipv4);
    return sizeof ipv4;
  }
  sockaddr_in6 ipv6{};
  if (inet_pton(AF_INET6, address.c_str(), &ipv6.sin6_addr) != 1) return 0;
  ipv6.sin6_family = AF_INET6;
  ipv6.sin6_port = htons(static_cast<std::uint16_t>(port));
  std::memcpy(&storage, &ipv6, sizeof ipv6);
  return sizeof ipv6;
}

}  // namespace

std::optional<std::string> why_no_port(const std::string& address, int port) {
  sockaddr_storage storage{};
  const socklen_t size = fill(address, port, storage);
  if (size == 0) return std::nullopt;  // no numeric address: the check of the configuration says so
  const UniqueFd probe(::socket(storage.ss_family, SOCK_STREAM | SOCK_CLOEXEC, 0));
  const int yes = 1;
  const bool is_free = probe.valid() && ::setsockopt(probe.get(), SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes) == 0 &&
                       ::bind(probe.get(), reinterpret_cast<const sockaddr*>(&storage), size) == 0;
  if (is_free) return std::nullopt;
  const int failure = errno;
  std::string text = "cannot listen on " + address + ":" + std::to_string(port) + ": ";
  if (failure == EADDRINUSE) return text + "another program has the port";
  if (failure == EADDRNOTAVAIL) return text + "no network card has this address yet";
  return text + std::strerror(failure);
}

}  // namespace fvd
