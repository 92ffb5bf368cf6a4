#pragma once

/// A TCP client that sends text and reads lines, with a deadline.

#include <array>
#include <chrono>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

namespace fvd {

class LineClient {
 public:
  explicit LineClient(int port) : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0) {
      throw std::runtime_error("cannot connect");
    }
  }
  /// By a unix socket.
  explicit LineClient(const std::filesystem::path& file) : socket_(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    file.string().copy(address.sun_path, sizeof address.sun_path - 1);
    if (::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0) {
      throw std::runtime_error("cannot connect");
    }
  }
  ~LineClient() { ::close(socket_); }
  LineClient(const LineClient&) = delete;
  LineClient& operator=(const LineClient&) = delete;

  void send(const std::string& bytes) {
    std::size_t sent = 0;
    while (sent < bytes.size()) {
      const auto count = ::send(socket_, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
      if (count <= 0) return;  // the server closed: what it said can still be read
      sent += static_cast<std::size_t>(count);
    }
  }

  /// Half-closes: the server sees the end of what it is sent, and may still answer.
  void finish_sending() { ::shutdown(socket_, SHUT_WR); }

  /// The next line; nothing after the deadline or when the server closed.
  std::optional<std::string> line(std::chrono::milliseconds within = std::chrono::seconds(5)) {
    const auto deadline = std::chrono::steady_clock::now() + within;
    for (;;) {
      if (const auto end = input_.find('\n'); end != std::string::npos) {
        std::string text = input_.substr(0, end);
        input_.erase(0, end + 1);
        return text;
      }
      if (closed_ || !receive(deadline)) return std::nullopt;
    }
  }

  /// The next so many bytes; nothing after the deadline or when the server closed before.
  std::optional<std::string> bytes(std::size_t count, std::chrono::milliseconds within = std::chrono::seconds(5)) {
    const auto deadline = std::chrono::steady_clock::now() + within;
    while (input_.size() < count) {
      if (closed_ || !receive(deadline)) return std::nullopt;
    }
    std::string text = input_.substr(0, count);
    input_.erase(0, count);
    return text;
  }

  /// True when the server closes the connection in time.
  bool closes(std::chrono::milliseconds within = std::chrono::seconds(5)) {
    const auto deadline = std::chrono::steady_clock::now() + within;
    while (!closed_ && receive(deadline)) {
    }
    return closed_;
  }

  std::string ask(const std::string& request) {
    send(request + "\n");
    return line().value_or("no answer");
  }

 private:
  bool receive(std::chrono::steady_clock::time_point deadline) {
    const auto left =
        std::chrono::duration_cast<std::chrono::milliseconds>(deadline - std::chrono::steady_clock::now());
    pollfd waiting{socket_, POLLIN, 0};
    if (left.count() <= 0 || ::poll(&waiting, 1, static_cast<int>(left.count())) <= 0) return false;
    std::array<char, 4096> chunk{};
    const auto count = ::recv(socket_, chunk.data(), chunk.size(), 0);
    if (count <= 0) {
      closed_ = true;
      return true;
    }
    input_.append(chunk.data(), static_cast<std::size_t>(count));
    return true;
  }

  int socket_;
  std::string input_;
  bool closed_ = false;
};

}  // namespace fvd
