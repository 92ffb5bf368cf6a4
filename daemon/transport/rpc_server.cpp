#include "daemon/transport/rpc_server.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <deque>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <utility>  // before Asio 1.74, which forgets it

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/write.hpp>
#include <spdlog/spdlog.h>

#include "core/base/error.hpp"
#include "core/runtime/guarded_thread.hpp"
#include "core/runtime/thread_ticks.hpp"
#include "daemon/api/dispatcher.hpp"
#include "daemon/api/methods/methods.hpp"
#include "daemon/transport/foreign_protocol.hpp"
#include "daemon/transport/port_file.hpp"
#include "daemon/transport/tcp_options.hpp"
#include "daemon/transport/worker.hpp"

namespace fvd {

namespace asio = boost::asio;
using asio::ip::tcp;
using ErrorCodeOf = boost::system::error_code;

namespace {

/// Limit of the replies that a client has not read; beyond it the connection is closed.
constexpr std::size_t kMaxUnsentBytes = 1U << 20U;
/// Limit of consecutive lines that are no JSON: such a client speaks another protocol.
constexpr int kMaxParseErrorsInARow = 3;
constexpr std::chrono::seconds kRefusalGrace{1};          // for a refused client to read the reason
constexpr std::chrono::milliseconds kShutdownGrace{500};  // for the replies that are owed when the server ends
constexpr std::chrono::milliseconds kShutdownPollPeriod{5};
constexpr std::chrono::seconds kTickInterval{1};     // of the network thread
constexpr std::chrono::seconds kLongestHandler{10};  // handlers wait for nothing: one that takes this long hangs

}  // namespace

struct RpcServer::Impl {
  class Session;

  Impl(const RpcConfig& c, const std::filesystem::path& runtime_dir, const Services& s)
      : config(c),
        services(s),
        dispatcher(all_methods(s), s),
        acceptor(context),
        accept_pause(context),
        shutdown_timer(context),
        port_file(runtime_dir / "rpc.json"),
        worker("fvd-rpc-work") {
    listen();
    write_port_file(port_file, config.address, port);
    accept();
    services.machine.on_change([this] { asio::post(context, [this] { resume_all(); }); });
    thread = start_thread("fvd-rpc", [this](const std::stop_token&) { run(); });
  }

  ~Impl() {
    services.machine.on_change({});
    asio::post(context, [this] { shut_down(std::chrono::steady_clock::now() + kShutdownGrace); });
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

  void accept();
  void run() {
    ThreadTicks ticks("fvd-rpc", kLongestHandler);
    for (; !context.stopped(); context.run_for(kTickInterval)) ticks.tick(HostClock::now());
  }
  /// Answers what has come by now, then ends the network thread; at the deadline at the latest.
  void shut_down(std::chrono::steady_clock::time_point deadline);
  [[nodiscard]] bool has_room();
  void resume_all();

  const RpcConfig config;
  const Services services;
  Dispatcher dispatcher;
  asio::io_context context;
  tcp::acceptor acceptor;
  asio::steady_timer accept_pause;
  asio::steady_timer shutdown_timer;
  std::filesystem::path port_file;
  int port = 0;
  std::set<std::shared_ptr<Session>> sessions;  // network thread only
  std::uint64_t connections = 0;                // since the start; network thread only
  Worker worker;                                // after what its tasks refer to
  std::jthread thread;                          // last
};

/// One connection. Network thread only.
class RpcServer::Impl::Session : public std::enable_shared_from_this<Session> {
 public:
  Session(Impl& server, tcp::socket socket)
      : server_(server),
        socket_(std::move(socket)),
        caller_{++server.connections, peer_of(socket_.native_handle())},
        idle_(server.context),
        wait_(server.context) {}

  void start() {
    tune(socket_.native_handle());
    watch_idle();
    read();
  }

  void refuse() {
    tune(socket_.native_handle());
    refuse_with(Dispatcher::too_many_connections());
    read();
  }

  /// Checks the waiting request again: a job changed, or the waiting time is over.
  void resume(bool timed_out) {
    check_wait(timed_out);
    process();
  }

  /// True if every request was answered and every reply was sent.
  [[nodiscard]] bool is_answered() const noexcept { return !has_request() && unsent_.empty(); }

  [[nodiscard]] bool is_half_closed() const noexcept { return half_closed_; }

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

 private:
  /// Restarts the idle timeout; an unfinished line does not restart it.
  void watch_idle() {
    idle_.expires_after(std::chrono::seconds(server_.config.idle_timeout_s));
    idle_.async_wait([self = shared_from_this()](ErrorCodeOf error) {
      // A connection with an open request is not idle; the request has a timeout of its own.
      if (!error && !self->has_request()) self->close();
    });
  }

  void read() {
    socket_.async_read_some(asio::buffer(chunk_), [self = shared_from_this()](ErrorCodeOf error, std::size_t count) {
      if (error == asio::error::eof && !self->refused_) return self->half_close();
      if (error) return self->close();
      // Input after a refusal is read and dropped: closing with unread input would discard the refusal.
      if (!self->refused_) {
        self->input_.append(self->chunk_.data(), count);
        self->process();
      }
      self->read();
    });
  }

  /// The client closed its sending side; its open requests are still answered.
  void half_close() {
    half_closed_ = true;
    close_if_all_is_said();
  }

  void close_if_all_is_said() {
    if (half_closed_ && !refused_ && !has_request() && unsent_.empty()) close();
  }

  /// True while a request is open: on the worker, or waiting for a job or the devices.
  [[nodiscard]] bool has_request() const noexcept { return at_work_ || waiting_.has_value(); }

  /// Runs `what`, which may block, on the worker, then the member `then` with its result on the network thread.
  template <typename Result>
  void work(std::function<Result(const Dispatcher&)> what, void (Session::*then)(Result)) {
    at_work_ = true;
    server_.worker.post([self = shared_from_this(), what = std::move(what), then]() mutable {
      Result result = what(self->server_.dispatcher);
      asio::io_context& context = self->server_.context;
      // The session is moved back: its destructor must run on the network thread.
      asio::post(context, [self = std::move(self), result = std::move(result), then]() mutable {
        self->at_work_ = false;
        if (!self->refused_) (self.get()->*then)(std::move(result));
      });
    });
  }

  /// Handles the whole lines at hand, in order; stops at a request that cannot be answered at once.
  void process() {
    std::size_t begin = 0;
    while (!has_request() && !refused_) {
      const std::size_t end = input_.find_first_of(std::string_view("\n\r\0", 3), begin);
      if (end == std::string::npos) break;
      const std::string_view line(input_.data() + begin, end - begin);
      begin = end + 1;
      if (line.size() > Dispatcher::kMaxLineBytes) return refuse_with(Dispatcher::too_long());
      if (line.find_first_not_of(" \t") == std::string_view::npos) continue;
      if (begins_foreign_protocol(line)) return refuse_with(Dispatcher::foreign_protocol());
      watch_idle();
      if (auto handled = server_.dispatcher.try_handle(line, caller_)) {
        take(std::move(*handled));
      } else {
        work<Handled>([line = std::string(line),
                       caller = caller_](const Dispatcher& dispatcher) { return dispatcher.handle(line, caller); },
                      &Session::take_and_go_on);
      }
    }
    if (refused_) return;
    input_.erase(0, begin);
    // Also limits the input that collects behind an open request.
    if (input_.size() > Dispatcher::kMaxLineBytes) return refuse_with(Dispatcher::too_long());
    close_if_all_is_said();
  }

  void take(Handled handled) {
    watch_idle();
    parse_errors_in_a_row_ = handled.is_parse_error ? parse_errors_in_a_row_ + 1 : 0;
    if (parse_errors_in_a_row_ == kMaxParseErrorsInARow) return refuse_with(Dispatcher::no_json());
    if (handled.reply) send(std::move(*handled.reply));
    if (handled.waiting && !refused_) begin_wait(std::move(*handled.waiting));
  }

  void take_and_go_on(Handled handled) {
    take(std::move(handled));
    process();
  }

  void begin_wait(WaitingRequest waiting) {
    timed_out_ = false;
    wait_.expires_after(waiting.until.timeout);
    waiting_ = std::move(waiting);
    wait_.async_wait([self = shared_from_this()](ErrorCodeOf error) {
      // An expiry that was already queued when the wait ended must not end the next wait.
      if (!error && self->wait_.expiry() <= std::chrono::steady_clock::now()) self->resume(true);
    });
    check_wait(false);
  }

  /// Checks on the worker whether the waiting request can be answered; a check during a check is made after it.
  void check_wait(bool timed_out) {
    if (!waiting_) return;
    timed_out_ = timed_out_ || timed_out;
    if (at_work_) {
      check_again_ = true;
      return;
    }
    if (!timed_out_ && !server_.dispatcher.may_have_come(*waiting_)) return;
    check_again_ = false;
    work<std::optional<std::string>>([waiting = *waiting_, late = timed_out_](
                                         const Dispatcher& dispatcher) { return dispatcher.resume(waiting, late); },
                                     &Session::end_wait);
  }

  void end_wait(std::optional<std::string> reply) {
    if (!reply) {
      if (check_again_) check_wait(false);
      return;
    }
    waiting_.reset();
    wait_.cancel();
    watch_idle();
    send(std::move(*reply));
    process();
  }

  /// Sends the reason and closes the connection after it.
  void refuse_with(std::string line) {
    refused_ = true;
    input_.clear();
    send(std::move(line));
    idle_.expires_after(kRefusalGrace);
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
                        self->close_if_all_is_said();
                      });
  }

  Impl& server_;
  tcp::socket socket_;
  Caller caller_;
  asio::steady_timer idle_;
  asio::steady_timer wait_;
  std::array<char, 4096> chunk_{};
  std::string input_;
  std::deque<std::string> unsent_;
  std::size_t unsent_bytes_ = 0;
  std::optional<WaitingRequest> waiting_;
  bool at_work_ = false;      // the worker runs a task of this session, one at a time
  bool timed_out_ = false;    // of waiting_
  bool check_again_ = false;  // a check was asked for during a check
  bool half_closed_ = false;
  bool refused_ = false;
  int parse_errors_in_a_row_ = 0;
};

void RpcServer::Impl::accept() {
  acceptor.async_accept([this](ErrorCodeOf error, tcp::socket socket) {
    if (error == asio::error::operation_aborted) return;
    if (error) {
      // Most likely no file descriptor is free: an immediate retry would only use CPU time.
      spdlog::warn("a connection could not be accepted: {}", error.message());
      accept_pause.expires_after(std::chrono::milliseconds(100));
      accept_pause.async_wait([this](ErrorCodeOf stopped) {
        if (!stopped) accept();
      });
      return;
    }
    const auto session = std::make_shared<Session>(*this, std::move(socket));
    const bool room = has_room();
    sessions.insert(session);
    if (room) {
      session->start();
    } else {
      session->refuse();
    }
    accept();
  });
}

bool RpcServer::Impl::has_room() {
  if (sessions.size() < static_cast<std::size_t>(config.max_connections)) return true;
  // A client that went away during a wait looks half-closed; its old connection must not keep it from reconnecting.
  const auto leaving = std::find_if(sessions.begin(), sessions.end(),
                                    [](const std::shared_ptr<Session>& session) { return session->is_half_closed(); });
  if (leaving == sessions.end()) return false;
  // A copy, for closing takes it out of the set. NOLINTNEXTLINE(performance-unnecessary-copy-initialization)
  const std::shared_ptr<Session> session = *leaving;
  session->close();
  return true;
}

void RpcServer::Impl::resume_all() {
  // A copy: a session may close, and so leave the set, while it is resumed.
  const auto all = sessions;
  for (const auto& session : all) session->resume(false);
}

void RpcServer::Impl::shut_down(std::chrono::steady_clock::time_point deadline) {
  ErrorCodeOf ignored;
  acceptor.close(ignored);
  resume_all();
  const bool all_is_said =
      std::all_of(sessions.begin(), sessions.end(), [](const auto& session) { return session->is_answered(); });
  if (all_is_said || std::chrono::steady_clock::now() >= deadline) return context.stop();
  shutdown_timer.expires_after(kShutdownPollPeriod);
  shutdown_timer.async_wait([this, deadline](ErrorCodeOf) { shut_down(deadline); });
}

RpcServer::RpcServer(const RpcConfig& config, const std::filesystem::path& runtime_dir, const Services& services)
    : impl_(std::make_unique<Impl>(config, runtime_dir, services)) {}
RpcServer::~RpcServer() = default;

int RpcServer::port() const noexcept { return impl_->port; }

}  // namespace fvd
