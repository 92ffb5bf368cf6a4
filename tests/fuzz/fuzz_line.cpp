/// What a connection makes of a stream of bytes does not depend on the pieces in which they come. The first two bytes
/// of the input say how the rest is cut, and whether a very long line is in it.

#include <array>
#include <chrono>
#include <memory>

#include <boost/asio/io_context.hpp>
#include <spdlog/spdlog.h>
#include <sys/socket.h>

#include "daemon/api/dispatcher.hpp"
#include "daemon/transport/rpc_session.hpp"
#include "daemon/transport/worker.hpp"
#include "tests/daemon/api/fake_job_service.hpp"
#include "tests/fuzz/fuzz_input.hpp"

namespace fvd::test {

namespace {

/// One method, which is answered at once: the order of replies is that of the lines.
MethodTable methods() {
  MethodTable table;
  Method& echo = table["echo"];
  echo.about = {
      .summary = "answers", .role = Role::kView, .params = described<NoParams>(), .result = described<NoParams>()};
  echo.peek = [](const Call&) -> std::optional<Answer> { return Reply{{"ok", true}}; };
  return table;
}

/// The client's end of a connection whose other end is a session in the same thread.
class Connection {
 public:
  explicit Connection(const Dispatcher& dispatcher, Worker& worker)
      : host_{context_,
              dispatcher,
              worker,
              worker,
              worker,
              std::chrono::minutes(5),
              std::chrono::minutes(5),
              [this](const std::shared_ptr<RpcSession>&) { closed_ = true; },
              [](const Identity&) { return true; }} {
    std::array<int, 2> ends{};
    require(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0, ends.data()) == 0);
    own_ = ends[0];
    const boost::asio::generic::stream_protocol protocol(AF_UNIX, 0);
    session_ = std::make_shared<RpcSession>(host_, RpcSession::Socket(context_, protocol, ends[1]),
                                            Caller{.who = {"fuzz", Role::kAdminister}});
    session_->start(false);
  }
  ~Connection() {
    if (!closed_) session_->close();
    session_.reset();
    context_.restart();
    context_.poll();  // handlers of the closed session
    ::close(own_);
  }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  void send(std::string_view bytes) {
    while (!bytes.empty()) {
      const ssize_t sent = ::send(own_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
      if (sent > 0) bytes.remove_prefix(static_cast<std::size_t>(sent));
      if (sent < 0 && errno != EAGAIN) return;  // it was closed
      let_it_work();
    }
  }
  /// All replies, up to the close that follows the end of what the client sends.
  std::string finish() {
    ::shutdown(own_, SHUT_WR);
    constexpr std::chrono::seconds kLongest{20};  // what comes after a refusal is dropped at a pace
    for (const auto begun = std::chrono::steady_clock::now(); !closed_;) {
      require(std::chrono::steady_clock::now() - begun < kLongest);
      let_it_work();
      if (!closed_) context_.run_one_for(std::chrono::milliseconds(20));
    }
    let_it_work();
    return std::move(replies_);
  }

 private:
  void let_it_work() {
    context_.restart();
    context_.poll();
    std::array<char, 4096> chunk{};
    for (ssize_t count = 0; (count = ::recv(own_, chunk.data(), chunk.size(), 0)) > 0;) {
      replies_.append(chunk.data(), static_cast<std::size_t>(count));
    }
  }

  boost::asio::io_context context_;
  RpcSessionHost host_;
  std::shared_ptr<RpcSession> session_;
  std::string replies_;
  int own_ = -1;
  bool closed_ = false;
};

}  // namespace

}  // namespace fvd::test

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace fvd;
  using namespace fvd::test;
  spdlog::set_level(spdlog::level::off);
  static FakeJobService service;
  static const Services services = service.services();
  static const Dispatcher dispatcher(methods(), services);
  static Worker worker("fuzz");

  InputReader input({bytes, size});
  const std::size_t piece = std::size_t{input.byte()} % 64 + 1;
  const std::uint8_t padding = input.byte();
  std::string stream(text_of(input.rest()));
  // Blanks that reach to the limit of a line, and some bytes beyond: libFuzzer would not make so many.
  if (padding < 64) stream.insert(std::min<std::size_t>(padding, stream.size()), Dispatcher::kMaxLineBytes - 32, ' ');

  Connection whole(dispatcher, worker);
  whole.send(stream);
  Connection pieces(dispatcher, worker);
  // Some hundred pieces tell as much as many thousand do.
  const std::size_t step = std::max(piece, stream.size() / 512 + 1);
  for (std::size_t at = 0; at < stream.size(); at += step) pieces.send(std::string_view(stream).substr(at, step));
  const std::string replies = whole.finish();
  require(replies == pieces.finish());
  require(replies.empty() || replies.back() == '\n');
  return 0;
}
