#include "daemon/transport/rpc_server.hpp"

#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <deque>
#include <fstream>
#include <set>
#include <string>
#include <thread>
#include <utility>  // before Asio 1.74, which forgets it

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/write.hpp>
#include <netinet/tcp.h>
#include <pthread.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include "core/base/error.hpp"
#include "daemon/api/dispatcher.hpp"
#include "daemon/transport/foreign_protocol.hpp"

namespace fvd {

namespace asio = boost::asio;
using asio::ip::tcp;
using ErrorCodeOf = boost::system::error_code;

namespace {

/// A client that lets this much pile up does not read; it is dropped rather than the memory filled.
constexpr std::size_t kMaxUnsentBytes = 1U << 20U;
/// Whoever sends so many lines that are no JSON speaks another language; what it sends next may be JSON by accident.
constexpr int kMaxParseErrorsInARow = 3;
/// A refused client has so long to read why.
constexpr std::chrono::seconds kFarewell{1};

void tune(tcp::socket& socket) {
  ErrorCodeOf ignored;
  socket.set_option(tcp::no_delay(true), ignored);
  socket.set_option(asio::socket_base::keep_alive(true), ignored);
  const int fd = socket.native_handle();
  const auto set = [fd](int option, int value) { ::setsockopt(fd, IPPROTO_TCP, option, &value, sizeof(value)); };
  set(TCP_KEEPIDLE, 10);
  set(TCP_KEEPINTVL, 5);
  set(TCP_KEEPCNT, 3);
  set(TCP_USER_TIMEOUT, 15000);
}

}  // namespace

struct RpcServer::Impl {
  class Session;

  Impl(const RpcConfig& c, const std::filesystem::path& runtime_dir, const Services& s)
      : config(c),
        services(s),
        dispatcher(s),
        acceptor(context),
        accept_pause(context),
        port_file(runtime_dir / "rpc.json") {
    listen();
    write_port_file();
    accept();
    services.machine.on_change([this] { asio::post(context, [this] { resume_all(); }); });
    thread = std::jthread([this] { context.run(); });
    pthread_setname_np(thread.native_handle(), "fvd-rpc");
  }

  ~Impl() {
    services.machine.on_change({});
    context.stop();
    thread.join();
    std::error_code ignored;
    std::filesystem::remove(port_file, ignored);
  }

  void listen() {
    ErrorCodeOf error;
    const auto address = asio::ip::make_address(config.address, error);
    if (!error) {
      const tcp::endpoint endpoint(address, static_cast<unsigned short>(config.port));
      acceptor.open(endpoint.protocol(), error);
      if (!error) acceptor.set_option(tcp::acceptor::reuse_address(true), error);
      if (!error) acceptor.bind(endpoint, error);
      if (!error) acceptor.listen(asio::socket_base::max_listen_connections, error);
    }
    if (error) {
      throw Error(ErrorCode::kBadConfig, "cannot listen on " + config.address + ":" + std::to_string(config.port) +
                                             ": " + error.message() + "; see /rpc/address and /rpc/port");
    }
    port = acceptor.local_endpoint().port();
  }

  void write_port_file() {
    std::error_code error;
    std::filesystem::create_directories(port_file.parent_path(), error);
    const auto temporary = port_file.string() + ".tmp";
    errno = 0;
    std::ofstream out(temporary);
    out << "{\"address\": \"" << config.address << "\", \"port\": " << port << ", \"pid\": " << ::getpid() << "}\n";
    out.close();
    if (!out || ::rename(temporary.c_str(), port_file.c_str()) != 0) {
      throw Error(ErrorCode::kStorageWrite,
                  "cannot write " + port_file.string() + ": " + std::strerror(errno) + "; see /paths/runtime_dir");
    }
  }

  void accept();
  void resume_all();

  const RpcConfig config;
  const Services services;
  Dispatcher dispatcher;
  asio::io_context context;
  tcp::acceptor acceptor;
  asio::steady_timer accept_pause;
  std::filesystem::path port_file;
  int port = 0;
  std::set<std::shared_ptr<Session>> sessions;  // network thread only
  std::jthread thread;                          // last
};

/// One connection. Network thread only.
class RpcServer::Impl::Session : public std::enable_shared_from_this<Session> {
 public:
  Session(Impl& server, tcp::socket socket)
      : server_(server), socket_(std::move(socket)), idle_(server.context), wait_(server.context) {}

  void start() {
    tune(socket_);
    watch_idle();
    read();
  }

  void refuse() {
    tune(socket_);
    refuse_with(Dispatcher::too_many_connections());
    read();
  }

  /// A job changed, or the waiting time is over: what waits for it may go on.
  void resume(bool timed_out) {
    if (!try_answer_wait(timed_out)) return;
    process();
  }

 private:
  /// Starts the time of silence anew; a line without its end is silence too.
  void watch_idle() {
    idle_.expires_after(std::chrono::seconds(server_.config.idle_timeout_s));
    idle_.async_wait([self = shared_from_this()](ErrorCodeOf error) {
      // A request that waits for a job is no silence; its own timeout ends it.
      if (!error && !self->waiting_) self->close();
    });
  }

  void read() {
    socket_.async_read_some(asio::buffer(chunk_), [self = shared_from_this()](ErrorCodeOf error, std::size_t count) {
      if (error) return self->close();
      // What comes after a refusal is read and dropped: closing with unread input would take the refusal with it.
      if (!self->refused_) {
        self->input_.append(self->chunk_.data(), count);
        self->process();
      }
      self->read();
    });
  }

  /// Handles the whole lines at hand, in order; stops at a request that has to wait.
  void process() {
    std::size_t begin = 0;
    while (!waiting_ && !refused_) {
      const std::size_t end = input_.find_first_of(std::string_view("\n\r\0", 3), begin);
      if (end == std::string::npos) break;
      const std::string_view line(input_.data() + begin, end - begin);
      begin = end + 1;
      if (line.size() > Dispatcher::kMaxLineBytes) return refuse_with(Dispatcher::too_long());
      if (line.find_first_not_of(" \t") == std::string_view::npos) continue;
      if (begins_foreign_protocol(line)) return refuse_with(Dispatcher::foreign_protocol());
      watch_idle();
      Handled handled = server_.dispatcher.handle(line);
      parse_errors_in_a_row_ = handled.is_parse_error ? parse_errors_in_a_row_ + 1 : 0;
      if (parse_errors_in_a_row_ == kMaxParseErrorsInARow) return refuse_with(Dispatcher::no_json());
      if (handled.reply) send(std::move(*handled.reply));
      if (handled.waiting) begin_wait(std::move(*handled.waiting));
    }
    input_.erase(0, begin);
    // Also bounds what piles up behind a request that waits.
    if (input_.size() > Dispatcher::kMaxLineBytes) refuse_with(Dispatcher::too_long());
  }

  void begin_wait(WaitingRequest waiting) {
    wait_.expires_after(waiting.timeout);
    waiting_ = std::move(waiting);
    wait_.async_wait([self = shared_from_this()](ErrorCodeOf error) {
      if (!error) self->resume(true);
    });
    (void)try_answer_wait(false);
  }

  /// True if the waiting request was answered.
  [[nodiscard]] bool try_answer_wait(bool timed_out) {
    if (!waiting_) return false;
    auto reply = server_.dispatcher.resume(*waiting_, timed_out);
    if (!reply) return false;
    waiting_.reset();
    wait_.cancel();
    watch_idle();
    send(std::move(*reply));
    return true;
  }

  /// Says why and ends the connection once that is said.
  void refuse_with(std::string line) {
    refused_ = true;
    input_.clear();
    send(std::move(line));
    idle_.expires_after(kFarewell);
    idle_.async_wait([self = shared_from_this()](ErrorCodeOf error) {
      if (!error) self->close();
    });
  }

  void send(std::string line) {
    line += '\n';
    unsent_bytes_ += line.size();
    unsent_.push_back(std::move(line));
    if (unsent_bytes_ > kMaxUnsentBytes) return close();
    if (unsent_.size() == 1) write();
  }

  void write() {
    asio::async_write(socket_, asio::buffer(unsent_.front()),
                      [self = shared_from_this()](ErrorCodeOf error, std::size_t count) {
                        if (error) return self->close();
                        self->unsent_bytes_ -= count;
                        self->unsent_.pop_front();
                        if (!self->unsent_.empty()) return self->write();
                        ErrorCodeOf ignored;
                        if (self->refused_) self->socket_.shutdown(tcp::socket::shutdown_send, ignored);
                      });
  }

  void close() {
    refused_ = true;
    waiting_.reset();
    ErrorCodeOf ignored;
    idle_.cancel();
    wait_.cancel();
    socket_.shutdown(tcp::socket::shutdown_both, ignored);
    socket_.close(ignored);
    server_.sessions.erase(shared_from_this());
  }

  Impl& server_;
  tcp::socket socket_;
  asio::steady_timer idle_;
  asio::steady_timer wait_;
  std::array<char, 4096> chunk_{};
  std::string input_;
  std::deque<std::string> unsent_;
  std::size_t unsent_bytes_ = 0;
  std::optional<WaitingRequest> waiting_;
  bool refused_ = false;
  int parse_errors_in_a_row_ = 0;
};

void RpcServer::Impl::accept() {
  acceptor.async_accept([this](ErrorCodeOf error, tcp::socket socket) {
    if (error) {
      // Out of file descriptors, most likely: trying again at once would only burn time.
      spdlog::warn("a connection could not be accepted: {}", error.message());
      accept_pause.expires_after(std::chrono::milliseconds(100));
      accept_pause.async_wait([this](ErrorCodeOf stopped) {
        if (!stopped) accept();
      });
      return;
    }
    const auto session = std::make_shared<Session>(*this, std::move(socket));
    const bool room = sessions.size() < static_cast<std::size_t>(config.max_connections);
    sessions.insert(session);
    if (room) {
      session->start();
    } else {
      session->refuse();
    }
    accept();
  });
}

void RpcServer::Impl::resume_all() {
  // A copy: a session may close, and so leave the set, while it is resumed.
  const auto all = sessions;
  for (const auto& session : all) session->resume(false);
}

RpcServer::RpcServer(const RpcConfig& config, const std::filesystem::path& runtime_dir, const Services& services)
    : impl_(std::make_unique<Impl>(config, runtime_dir, services)) {}
RpcServer::~RpcServer() = default;

int RpcServer::port() const noexcept { return impl_->port; }

}  // namespace fvd
