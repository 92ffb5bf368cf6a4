#include "daemon/ctl/line_socket.hpp"

#include <algorithm>
#include <cerrno>
#include <memory>
#include <system_error>

#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>

#include "core/base/error.hpp"

namespace fvd::ctl {

namespace {

using SteadyClock = std::chrono::steady_clock;

std::string errno_text(int error) { return std::generic_category().message(error); }

/// True when the socket is ready; false at the deadline.
bool wait_ready(int fd, short events, SteadyClock::time_point deadline) {
  for (;;) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - SteadyClock::now());
    pollfd entry{fd, events, 0};
    const int ready = ::poll(&entry, 1, static_cast<int>(std::max<std::int64_t>(0, left.count())));
    if (ready > 0) return true;
    if (ready == 0) return false;
    if (errno != EINTR) throw Error(ErrorCode::kInternal, "poll: " + errno_text(errno));
  }
}

struct AddressListDeleter {
  void operator()(addrinfo* list) const noexcept { ::freeaddrinfo(list); }
};
using AddressList = std::unique_ptr<addrinfo, AddressListDeleter>;

AddressList resolve(const RpcEndpoint& endpoint) {
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  const int error = ::getaddrinfo(endpoint.host.c_str(), std::to_string(endpoint.port).c_str(), &hints, &found);
  if (error != 0) {
    throw Error(ErrorCode::kNotReady, "cannot find host '" + endpoint.host + "': " + ::gai_strerror(error));
  }
  return AddressList(found);
}

/// The connected socket, or errno in `error`.
UniqueFd connect_to(const sockaddr& address, socklen_t size, SteadyClock::time_point deadline, int& error) {
  UniqueFd fd(::socket(address.sa_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  if (!fd.valid() || ::connect(fd.get(), &address, size) == 0) {
    error = fd.valid() ? 0 : errno;
    return fd;
  }
  error = errno;
  if (error == EINPROGRESS) {
    if (!wait_ready(fd.get(), POLLOUT, deadline)) {
      error = ETIMEDOUT;
    } else {
      socklen_t error_size = sizeof error;
      if (::getsockopt(fd.get(), SOL_SOCKET, SO_ERROR, &error, &error_size) != 0) error = errno;
    }
  }
  return error == 0 ? std::move(fd) : UniqueFd();
}

UniqueFd connect_to_socket(const std::string& path, SteadyClock::time_point deadline, int& error) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  error = ENAMETOOLONG;
  if (path.size() >= sizeof address.sun_path) return UniqueFd();
  path.copy(address.sun_path, path.size());
  return connect_to(reinterpret_cast<const sockaddr&>(address), sizeof address, deadline, error);
}

UniqueFd connect_to_host(const RpcEndpoint& endpoint, SteadyClock::time_point deadline, int& error) {
  const AddressList addresses = resolve(endpoint);
  UniqueFd fd;
  for (const addrinfo* address = addresses.get(); address != nullptr && !fd.valid(); address = address->ai_next) {
    fd = connect_to(*address->ai_addr, address->ai_addrlen, deadline, error);
  }
  const int on = 1;  // requests are single small segments; waiting for more only adds latency
  if (fd.valid()) (void)::setsockopt(fd.get(), IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  return fd;
}

}  // namespace

LineSocket::LineSocket(const RpcEndpoint& endpoint, std::chrono::milliseconds timeout) : endpoint_(endpoint) {
  const auto deadline = SteadyClock::now() + timeout;
  int error = EHOSTUNREACH;
  socket_ = endpoint.socket.empty() ? connect_to_host(endpoint, deadline, error)
                                    : connect_to_socket(endpoint.socket, deadline, error);
  if (!socket_.valid()) {
    throw Error(ErrorCode::kNotReady,
                "cannot connect to " + endpoint_.text() + ": " + errno_text(error) + ": is fvd running there?");
  }
}

void LineSocket::send_line(std::string_view line, std::chrono::milliseconds timeout) {
  send_bytes(std::string(line) + "\n", timeout);
}

void LineSocket::send_bytes(std::string_view bytes, std::chrono::milliseconds timeout) {
  const auto deadline = SteadyClock::now() + timeout;
  std::string_view rest = bytes;
  while (!rest.empty()) {
    const ssize_t sent = ::send(socket_.get(), rest.data(), rest.size(), MSG_NOSIGNAL);
    if (sent >= 0) {
      rest.remove_prefix(static_cast<std::size_t>(sent));
    } else if (errno == EAGAIN || errno == EWOULDBLOCK) {
      if (!wait_ready(socket_.get(), POLLOUT, deadline)) {
        throw Error(ErrorCode::kTimeout, endpoint_.text() + " did not take the request in time");
      }
    } else if (errno != EINTR) {
      throw Error(ErrorCode::kNotReady, "sending to " + endpoint_.text() + " failed: " + errno_text(errno));
    }
  }
}

bool LineSocket::take_line(std::string& line) {
  for (;;) {
    const auto end = received_.find('\n', searched_);
    if (end == std::string::npos) {
      searched_ = received_.size();
      return false;
    }
    line = received_.substr(0, end);
    received_.erase(0, end + 1);
    searched_ = 0;
    while (!line.empty() && line.back() == '\r') line.pop_back();
    if (!line.empty()) return true;
  }
}

std::string LineSocket::receive_some(std::chrono::milliseconds timeout) {
  const auto deadline = SteadyClock::now() + timeout;
  char buffer[16384];
  for (;;) {
    if (!wait_ready(socket_.get(), POLLIN, deadline)) {
      throw Error(ErrorCode::kTimeout,
                  endpoint_.text() + " did not answer within " + std::to_string(timeout.count()) + " ms");
    }
    const ssize_t size = ::recv(socket_.get(), buffer, sizeof buffer, 0);
    if (size > 0) return {buffer, static_cast<std::size_t>(size)};
    if (size == 0) throw Error(ErrorCode::kNotReady, endpoint_.text() + " closed the connection before it answered");
    if (errno != EAGAIN && errno != EWOULDBLOCK && errno != EINTR) {
      throw Error(ErrorCode::kNotReady, "receiving from " + endpoint_.text() + " failed: " + errno_text(errno));
    }
  }
}

std::string LineSocket::receive_line(std::chrono::milliseconds timeout) {
  const auto deadline = SteadyClock::now() + timeout;
  std::string line;
  while (!take_line(line)) {
    if (received_.size() > kMaxLineBytes) {
      throw Error(ErrorCode::kBadInput, endpoint_.text() + " sends a reply without end: is it an fvd?");
    }
    received_ += receive_some(std::chrono::ceil<std::chrono::milliseconds>(deadline - SteadyClock::now()));
  }
  return line;
}

}  // namespace fvd::ctl
