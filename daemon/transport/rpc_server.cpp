#include "daemon/transport/rpc_server.hpp"

#include <algorithm>
#include <chrono>
#include <set>
#include <string>
#include <thread>
#include <utility>  // before Asio 1.74, which forgets it

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <spdlog/spdlog.h>

#include "core/base/error.hpp"
#include "core/runtime/guarded_thread.hpp"
#include "core/runtime/thread_ticks.hpp"
#include "daemon/api/dispatcher.hpp"
#include "daemon/api/methods/methods.hpp"
#include "daemon/transport/port_file.hpp"
#include "daemon/transport/rpc_session.hpp"
#include "daemon/transport/worker.hpp"

namespace fvd {

namespace asio = boost::asio;
using asio::ip::tcp;
using ErrorCodeOf = boost::system::error_code;

namespace {

constexpr std::chrono::milliseconds kShutdownGrace{500};  // for the replies that are owed when the server ends
constexpr std::chrono::milliseconds kShutdownPollPeriod{5};
constexpr std::chrono::seconds kTickInterval{1};     // of the network thread
constexpr std::chrono::seconds kLongestHandler{10};  // handlers wait for nothing: one that takes this long hangs

}  // namespace

struct RpcServer::Impl {
  Impl(const RpcConfig& c, const std::filesystem::path& runtime_dir, const Services& s)
      : config(c),
        services(s),
        dispatcher(all_methods(s), s),
        acceptor(context),
        accept_pause(context),
        shutdown_timer(context),
        port_file(runtime_dir / "rpc.json"),
        host{context, dispatcher, worker, std::chrono::seconds(c.idle_timeout_s),
             [this](const std::shared_ptr<RpcSession>& session) { sessions.erase(session); }},
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
    remove_port_file(port_file);
  }

  void listen() {
    ErrorCodeOf error;
    const auto refuse = [&](ErrorCode code) {
      throw Error(code, "cannot listen on " + config.address + ":" + std::to_string(config.port) + ": " +
                            error.message() + "; see /rpc/address and /rpc/port");
    };
    const auto address = asio::ip::make_address(config.address, error);
    if (error) refuse(ErrorCode::kBadConfig);
    const tcp::endpoint endpoint(address, static_cast<unsigned short>(config.port));
    acceptor.open(endpoint.protocol(), error);
    if (!error) acceptor.set_option(tcp::acceptor::reuse_address(true), error);
    if (!error) acceptor.bind(endpoint, error);
    if (!error) acceptor.listen(asio::socket_base::max_listen_connections, error);
    // Another program may give the port free, and a network card may get its address later.
    if (error) refuse(ErrorCode::kNotReady);
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
  std::set<std::shared_ptr<RpcSession>> sessions;  // network thread only
  std::uint64_t connections = 0;                   // since the start; network thread only
  RpcSessionHost host;
  Worker worker;        // after what its tasks refer to
  std::jthread thread;  // last
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
    const auto session = std::make_shared<RpcSession>(host, std::move(socket), ++connections);
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
  const auto leaving = std::find_if(sessions.begin(), sessions.end(), [](const std::shared_ptr<RpcSession>& session) {
    return session->is_half_closed();
  });
  if (leaving == sessions.end()) return false;
  // A copy, for closing takes it out of the set. NOLINTNEXTLINE(performance-unnecessary-copy-initialization)
  const std::shared_ptr<RpcSession> session = *leaving;
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
