#include "daemon/transport/rpc_server.hpp"

#include <algorithm>
#include <chrono>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <utility>  // before Asio 1.74, which forgets it

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <spdlog/spdlog.h>

#include "core/runtime/guarded_thread.hpp"
#include "core/runtime/thread_ticks.hpp"
#include "daemon/api/dispatcher.hpp"
#include "daemon/api/methods/methods.hpp"
#include "daemon/transport/port_file.hpp"
#include "daemon/transport/rpc_session.hpp"
#include "daemon/transport/tcp_listener.hpp"
#include "daemon/transport/tcp_options.hpp"
#include "daemon/transport/unix_socket.hpp"
#include "daemon/transport/worker.hpp"

namespace fvd {

namespace asio = boost::asio;
namespace local = asio::local;
using asio::ip::tcp;
using ErrorCodeOf = boost::system::error_code;

namespace {

constexpr std::chrono::milliseconds kShutdownGrace{500};  // for the replies that are owed when the server ends
constexpr std::chrono::milliseconds kShutdownPollPeriod{5};
constexpr std::chrono::milliseconds kAcceptPause{100};
/// Connections beyond the limit that may log in, for one of them may be who has control.
constexpr std::ptrdiff_t kLogInPlaces = 4;
constexpr std::chrono::seconds kTickInterval{1};     // of the network thread
constexpr std::chrono::seconds kLongestHandler{10};  // handlers wait for nothing: one that takes this long hangs

}  // namespace

struct RpcServer::Impl {
  Impl(const RpcConfig& c, const std::filesystem::path& runtime_dir, const Services& s)
      : config(c),
        services(s),
        dispatcher(all_methods(s), s),
        acceptor(context),
        local_acceptor(context),
        shutdown_timer(context),
        port_file(runtime_dir / "rpc.json"),
        host{context,
             dispatcher,
             worker,
             logins,
             lists,
             std::chrono::seconds(c.idle_timeout_s),
             std::chrono::seconds(c.first_request_s),
             [this](const std::shared_ptr<RpcSession>& session) { sessions.erase(session); },
             [this](const Identity& who) { return has_room(who); }},
        worker("fvd-rpc-work"),
        logins("fvd-rpc-login"),
        lists("fvd-rpc-lists") {
    listen_on(acceptor, config.address, config.port, "/rpc");
    port = acceptor.local_endpoint().port();
    local_socket.emplace(c.socket.empty() ? runtime_dir / "fvd.sock" : c.socket);
    local_acceptor.assign(local::stream_protocol(), local_socket->take_listener());
    write_port_file(port_file, config.address, port, std::filesystem::absolute(local_socket->file()));
    accept(acceptor, [this](tcp::socket& socket) { return caller_at(socket); });
    accept(local_acceptor, [this](local::stream_protocol::socket& socket) { return caller_at(socket); });
    services.machine.on_change([this] { asio::post(context, [this] { resume_all(); }); });
    thread = start_thread("fvd-rpc", [this](const std::stop_token&) { run(); });
  }

  ~Impl() {
    services.machine.on_change({});
    asio::post(context, [this] { shut_down(std::chrono::steady_clock::now() + kShutdownGrace); });
    thread.join();
    remove_port_file(port_file);
  }

  /// Goes on accepting. recognise: who is at the other end.
  template <typename Acceptor, typename Recognise>
  void accept(Acceptor& from, Recognise recognise);
  [[nodiscard]] Caller caller_at(tcp::socket& socket) const;
  [[nodiscard]] Caller caller_at(local::stream_protocol::socket& socket) const;
  void admit(RpcSession::Socket socket, Caller caller);
  void run() {
    ThreadTicks ticks("fvd-rpc", kLongestHandler);
    for (; !context.stopped(); context.run_for(kTickInterval)) ticks.tick(HostClock::now());
  }
  /// Answers what has come by now, then ends the network thread; at the deadline at the latest.
  void shut_down(std::chrono::steady_clock::time_point deadline);
  /// The one with control; while nobody has it whoever may have it.
  [[nodiscard]] bool may_control(const Identity& who) const;
  [[nodiscard]] bool has_room(const Identity& who);
  /// For a connection that has to log in. The oldest of those that ask for nothing gives way.
  [[nodiscard]] bool has_log_in_place();
  void resume_all();

  const RpcConfig config;
  const Services services;
  Dispatcher dispatcher;
  asio::io_context context;
  tcp::acceptor acceptor;
  std::optional<UnixSocket> local_socket;
  local::stream_protocol::acceptor local_acceptor;
  asio::steady_timer shutdown_timer;
  std::filesystem::path port_file;
  int port = 0;
  std::set<std::shared_ptr<RpcSession>> sessions;  // network thread only
  std::uint64_t connections = 0;                   // since the start; network thread only
  RpcSessionHost host;
  Worker worker;  // after what its tasks refer to
  Worker logins;
  Worker lists;
  std::jthread thread;  // last
};

template <typename Acceptor, typename Recognise>
void RpcServer::Impl::accept(Acceptor& from, Recognise recognise) {
  from.async_accept([this, &from, recognise](ErrorCodeOf error, auto socket) {
    if (error == asio::error::operation_aborted) return;
    if (error) {
      // Most likely no file descriptor is free: an immediate retry would only use CPU time.
      spdlog::warn("a connection could not be accepted: {}", error.message());
      const auto pause = std::make_shared<asio::steady_timer>(context, kAcceptPause);
      pause->async_wait([this, &from, recognise, pause](ErrorCodeOf stopped) {
        if (!stopped && from.is_open()) accept(from, recognise);
      });
      return;
    }
    Caller caller = recognise(socket);
    admit(RpcSession::Socket(std::move(socket)), std::move(caller));
    accept(from, recognise);
  });
}

Caller RpcServer::Impl::caller_at(tcp::socket& socket) const {
  ErrorCodeOf gone;
  const std::string address = socket.remote_endpoint(gone).address().to_string(gone);
  Caller caller;
  caller.peer = peer_of(socket.native_handle());
  if (const auto bytes = address_bytes(address)) caller.who = services.access.of_address(*bytes, address);
  return caller;
}

Caller RpcServer::Impl::caller_at(local::stream_protocol::socket& socket) const {
  const LocalPeer peer = local_peer_of(socket.native_handle());
  Caller caller;
  caller.peer = "process " + std::to_string(peer.pid);
  caller.who = services.access.of_local_peer(peer);
  return caller;
}

void RpcServer::Impl::admit(RpcSession::Socket socket, Caller caller) {
  caller.connection = ++connections;
  // Whoever has no role may get one by a token.
  const bool allowed = caller.who.role > Role::kNone || services.access.has_tokens();
  const bool room = allowed && has_room(caller.who);
  if (!allowed) services.refusals.tell(caller.who.name, "a connection is refused: " + text_of(caller));
  const bool may_log_in = services.access.has_tokens() && (room || has_log_in_place());
  const auto session = std::make_shared<RpcSession>(host, std::move(socket), std::move(caller));
  sessions.insert(session);
  if (room || (allowed && may_log_in)) return session->start(!room);
  session->refuse(allowed ? Dispatcher::too_many_connections() : Dispatcher::not_allowed_here());
}

bool RpcServer::Impl::may_control(const Identity& who) const {
  const auto holder = services.control.holder();
  return holder ? holder->who == who.name : who.role >= Role::kOperate;
}

bool RpcServer::Impl::has_room(const Identity& who) {
  std::size_t taken = 0;
  std::size_t by_others = 0;
  for (const auto& session : sessions) {
    if (session->is_refused() || session->must_log_in()) continue;
    ++taken;
    if (!may_control(session->caller().who)) ++by_others;
  }
  const auto most = static_cast<std::size_t>(config.max_connections);
  const bool controls = may_control(who);
  if (!controls && by_others + 1 >= most) return false;  // one place is kept for who has control
  if (taken < most) return true;
  // A client that went away during a wait looks half-closed; its old connection must not keep it from reconnecting. Nor
  // may an old one of who has control keep him from his.
  const bool holds = controls && services.control.holder();
  const auto leaving = std::find_if(sessions.begin(), sessions.end(), [&](const auto& session) {
    if (session->is_refused() || session->must_log_in()) return false;
    return session->is_half_closed() || (holds && session->caller().who.name == who.name);
  });
  if (leaving == sessions.end()) return false;
  // A copy, for closing takes it out of the set. NOLINTNEXTLINE(performance-unnecessary-copy-initialization)
  const std::shared_ptr<RpcSession> session = *leaving;
  session->close();
  return true;
}

bool RpcServer::Impl::has_log_in_place() {
  std::ptrdiff_t logging_in = 0;
  std::shared_ptr<RpcSession> oldest;
  for (const auto& session : sessions) {
    if (!session->must_log_in() || session->is_refused()) continue;
    ++logging_in;
    if (!session->is_answered()) continue;
    if (!oldest || session->caller().connection < oldest->caller().connection) oldest = session;
  }
  if (logging_in < kLogInPlaces) return true;
  if (!oldest) return false;
  oldest->close();
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
  local_acceptor.close(ignored);
  const auto all = sessions;  // a copy, as in resume_all()
  for (const auto& session : all) session->end_waits();
  const bool all_is_said =
      std::all_of(sessions.begin(), sessions.end(), [](const auto& session) { return session->is_answered(); });
  if (all_is_said) return context.stop();
  if (std::chrono::steady_clock::now() >= deadline) {
    for (const auto& session : all) session->give_up();
    return context.stop();
  }
  shutdown_timer.expires_after(kShutdownPollPeriod);
  shutdown_timer.async_wait([this, deadline](ErrorCodeOf) { shut_down(deadline); });
}

RpcServer::RpcServer(const RpcConfig& config, const std::filesystem::path& runtime_dir, const Services& services)
    : impl_(std::make_unique<Impl>(config, runtime_dir, services)) {}
RpcServer::~RpcServer() = default;

int RpcServer::port() const noexcept { return impl_->port; }

}  // namespace fvd
