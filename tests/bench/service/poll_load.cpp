/// Clients that poll a daemon at a fixed rate, beside viewers that ask for much and never read.
///
/// poll_load PORT SEQ [SECONDS] [CALLS_PER_S] [CLIENTS] [VIEWERS]: asks in turns for the machine's state, the status of
/// the job with that number, and the heartbeat. The last line is one JSON object.

#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <nlohmann/json.hpp>
#include <sys/socket.h>
#include <unistd.h>

#include "core/runtime/guarded_thread.hpp"
#include "tests/bench/ping_load.hpp"

namespace fvd::bench {
namespace {

/// Large answers and pictures, of which not one byte is read.
constexpr std::string_view kWishes = R"({"jsonrpc":"2.0","id":1,"method":"rpc.discover"})"
                                     "\n"
                                     R"({"jsonrpc":"2.0","id":2,"method":"camera.preview"})"
                                     "\n"
                                     R"({"jsonrpc":"2.0","id":3,"method":"audit.list"})"
                                     "\n";

class Viewer {
 public:
  explicit Viewer(int port) : port_(port) { connect(); }
  ~Viewer() { ::close(socket_); }
  Viewer(const Viewer&) = delete;
  Viewer& operator=(const Viewer&) = delete;

  /// Sends as much as the system takes; comes back when the daemon has closed the connection.
  void press() {
    while (true) {
      const auto sent = ::send(socket_, kWishes.data(), kWishes.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
      if (sent > 0) continue;
      if (sent < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) return;
      ::close(socket_);
      ++closed_;
      return connect();
    }
  }
  [[nodiscard]] int closed() const { return closed_; }

 private:
  void connect() {
    socket_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port_));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    (void)::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address);  // or the next send fails
  }

  const int port_;
  int socket_ = -1;
  int closed_ = 0;
};

int run(int argc, char** argv) {
  if (argc < 3) {
    std::cerr << "usage: poll_load PORT SEQ [SECONDS] [CALLS_PER_S] [CLIENTS] [VIEWERS]\n";
    return 64;
  }
  const auto number = [&](int at, int standard) { return argc > at ? std::atoi(argv[at]) : standard; };
  const int port = number(1, 0);
  const std::string seq = std::to_string(number(2, 1));
  std::vector<std::unique_ptr<Viewer>> viewers;
  for (int i = 0; i < number(6, 8); ++i) viewers.push_back(std::make_unique<Viewer>(port));
  int closed = 0;
  auto pressing = start_thread("viewers", [&](const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      for (const auto& viewer : viewers) viewer->press();
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    for (const auto& viewer : viewers) closed += viewer->closed();
  });
  const auto times = ping_times_ms(
      port, {.clients = number(5, 8),
             .calls_per_s = number(4, 2000),
             .duration = std::chrono::seconds(number(3, 20)),
             .requests = {R"({"jsonrpc":"2.0","id":1,"method":"system.state"})",
                          R"({"jsonrpc":"2.0","id":2,"method":"job.status","params":{"seq":)" + seq + "}}",
                          R"({"jsonrpc":"2.0","id":3,"method":"system.ping"})"}});
  pressing.request_stop();
  pressing.join();
  std::cout << nlohmann::json{{"p50_ms", percentile(times, 0.5)},
                              {"p99_ms", percentile(times, 0.99)},
                              {"longest_ms", *std::max_element(times.begin(), times.end())},
                              {"calls", times.size()},
                              {"viewers_closed", closed}}
                   .dump()
            << std::endl;
  return 0;
}

}  // namespace
}  // namespace fvd::bench

int main(int argc, char** argv) {
  try {
    return fvd::bench::run(argc, argv);
  } catch (const std::exception& error) {
    std::cerr << "poll_load: " << error.what() << '\n';
    return 70;
  }
}
