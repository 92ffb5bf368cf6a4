#pragma once

/// A TCP server that plays a script: expects a request, sends what it was told, byte by byte if wanted.

#include <chrono>
#include <deque>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <nlohmann/json.hpp>
#include <poll.h>
#include <sys/socket.h>

#include "daemon/base/unique_fd.hpp"
#include "daemon/ctl/rpc_endpoint.hpp"

namespace fvd::test {

/// Serves one connection. The destructor fails the test if steps of the script are left.
class FakeRpcServer {
 public:
  struct Step {
    std::string method;               ///< expected
    std::vector<std::string> chunks;  ///< sent one by one; "$ID" stands for the request's id
    bool close = false;               ///< hang up afterwards
  };

  explicit FakeRpcServer(std::vector<Step> script) : script_(script.begin(), script.end()) {
    listener_ = UniqueFd(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    if (::bind(listener_.get(), reinterpret_cast<sockaddr*>(&address), size) != 0 ||
        ::listen(listener_.get(), 1) != 0 ||
        ::getsockname(listener_.get(), reinterpret_cast<sockaddr*>(&address), &size) != 0) {
      throw std::runtime_error("the fake server cannot listen");
    }
    port_ = ntohs(address.sin_port);
    thread_ = std::jthread([this](const std::stop_token& stop) { serve(stop); });
  }
  ~FakeRpcServer() {
    thread_.request_stop();
    thread_.join();
    for (const Step& step : script_) ADD_FAILURE() << "the client never asked for " << step.method;
  }
  FakeRpcServer(const FakeRpcServer&) = delete;
  FakeRpcServer& operator=(const FakeRpcServer&) = delete;

  [[nodiscard]] ctl::RpcEndpoint endpoint() const { return {"127.0.0.1", port_}; }

  /// Requests so far. Complete once the client has its last answer.
  [[nodiscard]] std::vector<nlohmann::json> requests() const {
    const std::lock_guard lock(mutex_);
    return requests_;
  }

  /// A whole reply.
  static std::vector<std::string> result(const nlohmann::json& value) {
    return {R"({"jsonrpc":"2.0","id":$ID,"result":)" + value.dump() + "}\n"};
  }
  /// Anything, in one piece.
  static std::vector<std::string> raw(const std::string& bytes) { return {bytes}; }
  static std::vector<std::string> error(const nlohmann::json& value) {
    return {R"({"jsonrpc":"2.0","id":$ID,"error":)" + value.dump() + "}\n"};
  }

 private:
  static bool readable(int fd, const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      pollfd entry{fd, POLLIN, 0};
      if (::poll(&entry, 1, 20) > 0) return true;
    }
    return false;
  }

  void serve(const std::stop_token& stop) {
    if (!readable(listener_.get(), stop)) return;
    const UniqueFd client(::accept4(listener_.get(), nullptr, nullptr, SOCK_CLOEXEC));
    std::string received;
    while (readable(client.get(), stop)) {
      char buffer[4096];
      const ssize_t size = ::recv(client.get(), buffer, sizeof buffer, 0);
      if (size <= 0) return;
      received.append(buffer, static_cast<std::size_t>(size));
      for (auto end = received.find('\n'); end != std::string::npos; end = received.find('\n')) {
        const auto request = nlohmann::json::parse(received.substr(0, end));
        received.erase(0, end + 1);
        if (!answer(client.get(), request)) return;
      }
    }
  }

  /// False to hang up.
  bool answer(int client, const nlohmann::json& request) {
    const std::lock_guard lock(mutex_);
    requests_.push_back(request);
    if (script_.empty()) {
      ADD_FAILURE() << "unexpected request " << request;
      return false;
    }
    const Step step = std::move(script_.front());
    script_.pop_front();
    EXPECT_EQ(request["method"], step.method);
    EXPECT_EQ(request["jsonrpc"], "2.0");
    for (std::string chunk : step.chunks) {
      if (const auto place = chunk.find("$ID"); place != std::string::npos) {
        chunk.replace(place, 3, request["id"].dump());
      }
      EXPECT_EQ(::send(client, chunk.data(), chunk.size(), MSG_NOSIGNAL), static_cast<ssize_t>(chunk.size()));
    }
    return !step.close;
  }

  UniqueFd listener_;
  int port_ = 0;
  mutable std::mutex mutex_;
  std::deque<Step> script_;               // guarded by mutex_ while the thread runs
  std::vector<nlohmann::json> requests_;  // guarded by mutex_
  std::jthread thread_;                   // last: uses everything above
};

}  // namespace fvd::test
