#include "daemon/transport/http_server.hpp"

#include <algorithm>
#include <chrono>
#include <set>
#include <string>
#include <thread>
#include <utility>  // before Asio 1.74, which forgets it

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>

#include "core/runtime/guarded_thread.hpp"
#include "core/runtime/thread_ticks.hpp"
#include "daemon/api/methods/methods.hpp"
#include "daemon/api/replies.hpp"
#include "daemon/api/rpc_errors.hpp"
#include "daemon/transport/http_session.hpp"
#include "daemon/transport/tcp_listener.hpp"

namespace fvd {

namespace asio = boost::asio;
using asio::ip::tcp;
using ErrorCodeOf = boost::system::error_code;

namespace {

constexpr std::size_t kMaxConnections = 64;
constexpr std::ptrdiff_t kMostWithoutToken = kMaxConnections / 2;  // requests; the other places are of known callers
constexpr std::chrono::milliseconds kShutdownGrace{500};           // for the answers that are owed when the server ends
constexpr std::chrono::milliseconds kShutdownPollPeriod{5};
constexpr std::chrono::milliseconds kAcceptPause{100};
constexpr std::chrono::seconds kTickInterval{1};     // of the network thread
constexpr std::chrono::seconds kLongestHandler{10};  // handlers wait for nothing: one that takes this long hangs

std::vector<std::string> names_of(const std::vector<HttpHost>& hosts) {
  std::vector<std::string> names;
  for (const HttpHost& host : hosts) names.push_back(host.name);
  return names;
}

/// Browsers share connections among pages: what one of them says of itself must not hold for the next.
MethodTable methods_without_log_in(const Services& services) {
  MethodTable methods = all_methods(services);
  methods.at("session.login").run = [](const Call&) -> Answer {
    throw ProtocolError{json_rpc::kInvalidRequest,
                        "over HTTP each request brings its own token, in the header field Authorization: Bearer TOKEN"};
  };
  return methods;
}

}  // namespace

struct HttpServer::Impl {
  Impl(const HttpConfig& config, const Services& s, std::vector<MountedResource> mounted)
      : services(s),
        resources(std::move(mounted)),
        dispatcher(methods_without_log_in(s), s),
        gate(names_of(config.hosts)),
        acceptor(context),
        pause(context),
        host{context,
             dispatcher,
             s.access,
             gate,
             wrong_tokens,
             s.refusals,
             failed_fetches,
             worker,
             logins,
             files,
             resources,
             [this](const std::shared_ptr<HttpSession>& session) { sessions.erase(session); },
             [this] { return has_room_without_token(); }},
        worker("fvd-http-work"),
        logins("fvd-http-login"),
        files("fvd-http-files") {
    listen_on(acceptor, config.address, *config.port, "/http");
    port = acceptor.local_endpoint().port();
    accept();
    services.machine.on_change([this] { asio::post(context, [this] { resume_all(); }); }, this);
    thread = start_thread("fvd-http", [this](const std::stop_token&) { run(); });
  }

  ~Impl() {
    services.machine.on_change({}, this);
    asio::post(context, [this] { shut_down(std::chrono::steady_clock::now() + kShutdownGrace); });
    thread.join();
  }

  void accept() {
    acceptor.async_accept([this](ErrorCodeOf error, tcp::socket socket) {
      if (error == asio::error::operation_aborted) return;
      if (error) {
        // Most likely no file descriptor is free: an immediate retry would only use CPU time.
        pause.expires_after(kAcceptPause);
        pause.async_wait([this](ErrorCodeOf stopped) {
          if (!stopped && acceptor.is_open()) accept();
        });
        return;
      }
      admit(std::move(socket));
      accept();
    });
  }

  void admit(tcp::socket socket) {
    const bool has_room = sessions.size() < kMaxConnections || make_room();
    const auto session = std::make_shared<HttpSession>(host, std::move(socket), ++connections);
    // Beyond the limit there are as many again that are being told so.
    if (!has_room && sessions.size() >= 2 * kMaxConnections) return;
    sessions.insert(session);
    if (has_room) {
      session->start();
    } else {
      session->turn_away();
    }
  }

  /// Closes the connection that has had nothing at work for longest, else the one whose token has been looked up for
  /// longest; false if all are answered.
  bool make_room() {
    const auto oldest = std::min_element(sessions.begin(), sessions.end(), [](const auto& a, const auto& b) {
      return std::pair(a->at_work(), a->since()) < std::pair(b->at_work(), b->since());
    });
    if (oldest == sessions.end() || is_answered(*oldest)) return false;
    // A copy, for closing takes it out of the set. NOLINTNEXTLINE(performance-unnecessary-copy-initialization)
    const std::shared_ptr<HttpSession> session = *oldest;
    session->close();
    return true;
  }

  static bool is_answered(const std::shared_ptr<HttpSession>& session) {
    return session->at_work() == HttpSession::AtWork::kAnswer;
  }

  /// Whoever can reach the port may wait for answers: those keep nobody with a token from a place.
  [[nodiscard]] bool has_room_without_token() const {
    return std::count_if(sessions.begin(), sessions.end(), [](const auto& session) {
             return is_answered(session) && !session->has_token();
           }) < kMostWithoutToken;
  }

  void resume_all() {
    // A copy: a session may close, and so leave the set, while it is resumed.
    const auto all = sessions;
    for (const auto& session : all) session->resume();
  }

  void run() {
    ThreadTicks ticks("fvd-http", kLongestHandler);
    for (; !context.stopped(); context.run_for(kTickInterval)) ticks.tick(HostClock::now());
  }

  /// Answers what has come by now, then ends the network thread; at the deadline at the latest.
  void shut_down(std::chrono::steady_clock::time_point deadline) {
    ErrorCodeOf ignored;
    acceptor.close(ignored);
    const auto all = sessions;  // a copy, as in resume_all()
    for (const auto& session : all) session->end_wait_now();
    const bool is_quiet = std::none_of(sessions.begin(), sessions.end(), [](const auto& session) {
      return session->at_work() != HttpSession::AtWork::kNothing;
    });
    if (is_quiet) return context.stop();
    if (std::chrono::steady_clock::now() >= deadline) {
      for (const auto& session : all) session->give_up();
      return context.stop();
    }
    pause.expires_after(kShutdownPollPeriod);
    pause.async_wait([this, deadline](ErrorCodeOf) { shut_down(deadline); });
  }

  const Services services;
  const std::vector<MountedResource> resources;
  const Dispatcher dispatcher;
  const HttpGate gate;
  asio::io_context context;
  tcp::acceptor acceptor;
  asio::steady_timer pause;
  int port = 0;
  WrongTokens wrong_tokens;  // network thread only, as the next two
  std::set<std::shared_ptr<HttpSession>> sessions;
  std::uint64_t connections = 0;  // since the start
  RefusedCalls failed_fetches;
  HttpSessionHost host;
  Worker worker;  // after what its tasks refer to
  Worker logins;
  Worker files;
  std::jthread thread;  // last
};

HttpServer::HttpServer(const HttpConfig& config, const Services& services, std::vector<MountedResource> resources)
    : impl_(std::make_unique<Impl>(config, services, std::move(resources))) {}
HttpServer::~HttpServer() = default;

int HttpServer::port() const noexcept { return impl_->port; }

}  // namespace fvd
