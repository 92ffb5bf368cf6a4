#include "sim/gcs/gcs_server.hpp"

#include <array>
#include <atomic>
#include <cerrno>
#include <thread>

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include "core/runtime/guarded_thread.hpp"
#include "sim/base/file_descriptor.hpp"
#include "sim/base/listening_socket.hpp"
#include "sim/base/pseudo_terminal.hpp"

namespace fvd::sim {

struct GcsServer::Impl {
  Impl(GcsController& one, const GcsServerOptions& options)
      : controller(one),
        listener(options.terminal_link ? -1 : listening_socket(options.address, options.port)),
        wake(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)),
        port(options.terminal_link ? 0 : bound_port(listener.get())) {
    if (options.terminal_link) terminal.emplace(*options.terminal_link);
    thread = start_thread("sim-gcs", [this](const std::stop_token& stop) { serve(stop); });
  }

  ~Impl() {
    thread.request_stop();
    const std::uint64_t one = 1;
    [[maybe_unused]] const auto written = ::write(wake.get(), &one, sizeof(one));
  }

  void serve(const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      const int line = terminal ? terminal->master() : client ? client->get() : -1;
      std::array<pollfd, 3> waiting{pollfd{wake.get(), POLLIN, 0}, pollfd{listener.get(), POLLIN, 0},
                                    pollfd{line, POLLIN, 0}};
      if (::poll(waiting.data(), waiting.size(), -1) < 0 && errno != EINTR) return;
      if (terminal) terminal->end_exclusive_use();
      if (waiting[2].revents != 0) receive(line);
      if (waiting[1].revents != 0) accept_client();
    }
  }

  /// The newest client has the line: a driver that reopens it has given up the old connection.
  void accept_client() {
    const int fd = ::accept4(listener.get(), nullptr, nullptr, SOCK_CLOEXEC);
    if (fd < 0) return;
    const int on = 1;
    ::setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &on, sizeof(on));
    client = std::make_unique<FileDescriptor>(fd);
    controller.line_closed();
  }

  void receive(int line) {
    std::array<char, 512> chunk{};
    const auto count = ::read(line, chunk.data(), chunk.size());
    if (count < 0 && (errno == EAGAIN || errno == EINTR)) return;
    if (count <= 0) {
      client.reset();
      controller.line_closed();
      return;
    }
    ++requests;
    if (mute) return;
    const std::string answers = controller.take({chunk.data(), static_cast<std::size_t>(count)});
    if (answers.empty()) return;
    if (lost_answers > 0) {
      --lost_answers;
      return;
    }
    [[maybe_unused]] const auto sent = terminal ? ::write(line, answers.data(), answers.size())
                                                : ::send(line, answers.data(), answers.size(), MSG_NOSIGNAL);
  }

  GcsController& controller;
  FileDescriptor listener;
  std::optional<PseudoTerminal> terminal;  // or a listener
  FileDescriptor wake;
  int port;
  std::unique_ptr<FileDescriptor> client;  // server thread only
  std::atomic<std::uint64_t> requests{0};
  std::atomic<bool> mute{false};
  std::atomic<int> lost_answers{0};
  std::jthread thread;  // last
};

GcsServer::GcsServer(GcsController& controller, const GcsServerOptions& options)
    : impl_(std::make_unique<Impl>(controller, options)) {}
GcsServer::~GcsServer() = default;

int GcsServer::port() const noexcept { return impl_->port; }
std::string GcsServer::device() const { return impl_->terminal ? impl_->terminal->path().string() : std::string(); }
std::uint64_t GcsServer::requests() const noexcept { return impl_->requests; }
void GcsServer::set_mute(bool mute) { impl_->mute = mute; }
void GcsServer::lose_answers(int count) { impl_->lost_answers = count; }

}  // namespace fvd::sim
