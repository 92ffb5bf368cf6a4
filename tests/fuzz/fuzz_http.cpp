/// What an HTTP connection makes of a stream of bytes: nothing is called that the gate would not let in, and what is
/// called does not depend on the pieces in which the bytes come. (How an end in the middle of a header is told does.)
/// The first byte of the input says how they are cut.

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <string>
#include <string_view>
#include <utility>  // before Asio 1.74, which forgets it
#include <vector>

#include <boost/asio/io_context.hpp>
#include <spdlog/spdlog.h>
#include <sys/socket.h>
#include <unistd.h>

#include "daemon/api/dispatcher.hpp"
#include "daemon/transport/http_session.hpp"
#include "tests/daemon/api/fake_job_service.hpp"

namespace fvd::test {

namespace {

void demand(bool holds) {
  if (!holds) std::abort();
}

bool holds_in_any_case(std::string_view text, std::string_view lower) {
  return std::search(text.begin(), text.end(), lower.begin(), lower.end(), [](char a, char b) {
           return (a >= 'A' && a <= 'Z' ? static_cast<char>(a - 'A' + 'a') : a) == b;
         }) != text.end();
}

int calls = 0;
std::atomic<int> fetched = 0;

/// Answers whatever is fetched, after a look at what is asked for.
class Fetched final : public HttpResource {
 public:
  [[nodiscard]] bool needs_view() const override { return false; }
  [[nodiscard]] ResourceAnswer get(const ResourceRequest& request) override {
    demand(request.path.starts_with("/") && (request.path + "/").find("/../") == std::string::npos);
    for (const char c : request.path) demand(static_cast<unsigned char>(c) >= 0x20 && c != 0x7f);
    ++fetched;
    ResourceAnswer answer;
    answer.body = "fetched";
    return answer;
  }
};

/// One method, which is answered at once and counts.
MethodTable methods() {
  MethodTable table;
  Method& echo = table["echo"];
  echo.about = {
      .summary = "answers", .role = Role::kNone, .params = described<NoParams>(), .result = described<NoParams>()};
  echo.peek = [](const Call&) -> std::optional<Answer> {
    ++calls;
    return Reply{{"ok", true}};
  };
  return table;
}

/// What all connections share.
struct Front {
  FakeJobService service;
  const Services services = service.services();
  const Dispatcher dispatcher{methods(), services};
  const HttpGate gate{{"fvd.example"}};
  WrongTokens wrong_tokens;
  RefusedCalls refused_calls;
  RefusedCalls failed_fetches;
  Fetched fetched_resource;
  const std::vector<MountedResource> resources{{"/", &fetched_resource}};
};

/// The client's end of a connection whose other end is a session in the same thread.
class Connection {
 public:
  explicit Connection(Front& front)
      : host_{context_,
              front.dispatcher,
              front.services.access,
              front.gate,
              front.wrong_tokens,
              front.refused_calls,
              front.failed_fetches,
              worker_,
              worker_,
              worker_,
              front.resources,
              [this](const std::shared_ptr<HttpSession>&) { closed_ = true; },
              [] { return true; }} {
    std::array<int, 2> ends{};
    demand(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0, ends.data()) == 0);
    own_ = ends[0];
    session_ =
        std::make_shared<HttpSession>(host_, HttpSession::Socket(context_, boost::asio::ip::tcp::v4(), ends[1]), 1);
    session_->start();
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
  /// All answers, up to what follows the end of what the client sends.
  std::string finish() {
    ::shutdown(own_, SHUT_WR);
    for (int turn = 0; turn < 20 && !closed_; ++turn) let_it_work();
    let_it_work();
    return std::move(answers_);
  }

 private:
  void let_it_work() {
    context_.restart();
    context_.poll();
    std::array<char, 4096> chunk{};
    for (ssize_t count = 0; (count = ::recv(own_, chunk.data(), chunk.size(), 0)) > 0;) {
      answers_.append(chunk.data(), static_cast<std::size_t>(count));
    }
  }

  boost::asio::io_context context_;
  HttpSessionHost host_;
  std::shared_ptr<HttpSession> session_;
  std::string answers_;
  int own_ = -1;
  bool closed_ = false;
  Worker worker_{"fuzz"};  // last: its tasks come back to the context
};

}  // namespace

}  // namespace fvd::test

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace fvd::test;
  spdlog::set_level(spdlog::level::off);
  if (size == 0) return 0;
  static Front front;
  const std::size_t piece = std::size_t{bytes[0]} % 64 + 1;
  const std::string_view stream(reinterpret_cast<const char*>(bytes) + 1, size - 1);

  calls = 0;
  fetched = 0;
  Connection whole(front);
  whole.send(stream);
  const std::string answers = whole.finish();
  demand(answers.empty() || answers.rfind("HTTP/1.1 ", 0) == 0);
  // Nobody is called but by a request that says all that a foreign page cannot make a browser say.
  if (calls > 0) {
    demand(holds_in_any_case(stream, "application/json") && stream.find("/api/jsonrpc") != std::string_view::npos);
    demand(holds_in_any_case(stream, "host"));
  }
  const int calls_of_whole = calls;
  if (fetched > 0) demand(holds_in_any_case(stream, "host"));
  // A token is looked for on a worker, in its own time; so is what is fetched, and what is called behind it.
  if (holds_in_any_case(stream, "authorization") || holds_in_any_case(stream, "get ") ||
      holds_in_any_case(stream, "head ")) {
    return 0;
  }
  Connection pieces(front);
  for (std::size_t at = 0; at < stream.size(); at += piece) pieces.send(stream.substr(at, piece));
  (void)pieces.finish();
  demand(calls == 2 * calls_of_whole);
  return 0;
}
