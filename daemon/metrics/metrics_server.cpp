#include "daemon/metrics/metrics_server.hpp"

#include <chrono>
#include <string>
#include <thread>
#include <utility>  // before Asio 1.74, which forgets it

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <spdlog/spdlog.h>

#include "core/runtime/guarded_thread.hpp"
#include "core/runtime/thread_ticks.hpp"
#include "daemon/metrics/metrics_page.hpp"
#include "daemon/transport/tcp_listener.hpp"

namespace fvd {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;
using asio::ip::tcp;
using ErrorCodeOf = boost::system::error_code;

namespace {

constexpr std::chrono::seconds kRequestTime{5};   // from the connection to the end of the reply
constexpr std::chrono::seconds kTickInterval{1};  // of the thread
constexpr std::chrono::seconds kLongestHandler{10};
constexpr std::uint32_t kMaxHeader_bytes = 8192;
constexpr int kMaxConnections = 8;

using Response = http::response<http::string_body>;

Response respond(const http::request<http::empty_body>& request, const MachineStatus& machine) {
  Response response{http::status::ok, request.version()};
  response.set(http::field::content_type, "text/plain; charset=utf-8");
  const std::string target(request.target());
  if (request.method() != http::verb::get && request.method() != http::verb::head) {
    response.result(http::status::method_not_allowed);
    response.set(http::field::allow, "GET, HEAD");
    response.body() = "only GET and HEAD\n";
  } else if (target == "/metrics") {
    response.set(http::field::content_type, "text/plain; version=0.0.4; charset=utf-8");
    response.body() = metrics_text(machine);
  } else if (target == "/healthz") {
    const auto reason = why_unhealthy(machine);
    if (reason) response.result(http::status::service_unavailable);
    response.body() = reason.value_or("ok") + "\n";
  } else {
    response.result(http::status::not_found);
    response.body() = "there are /metrics and /healthz\n";
  }
  response.keep_alive(false);
  response.prepare_payload();
  if (request.method() == http::verb::head) response.body().clear();  // the length stays
  return response;
}

/// One connection: a request, its reply, the end. context: the server's thread.
class Connection : public std::enable_shared_from_this<Connection> {
 public:
  Connection(tcp::socket socket, const MachineView& machine, int& open)
      : stream_(std::move(socket)), machine_(machine), open_(open) {
    ++open_;
    parser_.header_limit(kMaxHeader_bytes);
    parser_.body_limit(0);
  }
  ~Connection() { --open_; }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  void start() {
    stream_.expires_after(kRequestTime);
    http::async_read_header(stream_, buffer_, parser_, [self = shared_from_this()](ErrorCodeOf error, std::size_t) {
      if (!error) self->reply();
    });
  }

 private:
  void reply() {
    response_ = respond(parser_.get(), *machine_.snapshot());
    http::async_write(stream_, response_, [self = shared_from_this()](ErrorCodeOf, std::size_t) {
      ErrorCodeOf ignored;
      self->stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
    });
  }

  beast::tcp_stream stream_;
  const MachineView& machine_;
  int& open_;
  beast::flat_buffer buffer_{kMaxHeader_bytes};
  http::request_parser<http::empty_body> parser_;
  Response response_;
};

}  // namespace

struct MetricsServer::Impl {
  Impl(const std::string& address, int port, const MachineView& view)
      : machine(view), acceptor(context), pause(context) {
    listen_on(acceptor, address, port, "/metrics");
    accept();
    thread = start_thread("fvd-metrics", [this](const std::stop_token& stop) { run(stop); });
  }

  void accept() {
    acceptor.async_accept([this](ErrorCodeOf error, tcp::socket socket) {
      if (error == asio::error::operation_aborted) return;
      if (error) {
        // Most likely no file descriptor is free: an immediate retry would only use CPU time.
        pause.expires_after(std::chrono::milliseconds(100));
        pause.async_wait([this](ErrorCodeOf stopped) {
          if (!stopped) accept();
        });
        return;
      }
      if (open < kMaxConnections) std::make_shared<Connection>(std::move(socket), machine, open)->start();
      accept();
    });
  }

  void run(const std::stop_token& stop) {
    ThreadTicks ticks("fvd-metrics", kLongestHandler);
    while (!stop.stop_requested()) {
      ticks.tick(HostClock::now());
      context.run_for(kTickInterval);
    }
  }

  ~Impl() {
    thread.request_stop();
    context.stop();
    thread.join();
  }

  const MachineView& machine;
  int open = 0;  // connections; before the context, whose end destroys them
  asio::io_context context;
  tcp::acceptor acceptor;
  asio::steady_timer pause;
  std::jthread thread;  // last
};

MetricsServer::MetricsServer(const std::string& address, int port, const MachineView& machine)
    : impl_(std::make_unique<Impl>(address, port, machine)) {}
MetricsServer::~MetricsServer() = default;

int MetricsServer::port() const noexcept {
  ErrorCodeOf ignored;
  return impl_->acceptor.local_endpoint(ignored).port();
}

}  // namespace fvd
