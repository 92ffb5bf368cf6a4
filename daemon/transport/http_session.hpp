#pragma once

/// One connection of a client that speaks HTTP: a request, its answer, the next request.

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>  // before Asio 1.74, which forgets it
#include <vector>

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http.hpp>

#include "daemon/access/access_rules.hpp"
#include "daemon/access/refused_calls.hpp"
#include "daemon/api/dispatcher.hpp"
#include "daemon/transport/http_gate.hpp"
#include "daemon/transport/http_resource.hpp"
#include "daemon/transport/worker.hpp"
#include "daemon/transport/wrong_tokens.hpp"

namespace fvd {

class HttpSession;

/// What a session needs of its server; all of it outlives the session.
struct HttpSessionHost {
  boost::asio::io_context& context;  ///< run by the server's thread
  const Dispatcher& dispatcher;
  const AccessRules& access;
  const HttpGate& gate;
  WrongTokens& wrong_tokens;
  RefusedCalls& refused_calls;
  RefusedCalls& failed_fetches;  ///< the same limit, for what could not be answered
  Worker& worker;                ///< for calls that may block
  Worker& logins;                ///< for the token file: nobody waits behind a slow call to be recognised
  Worker& files;                 ///< for what is fetched: no call waits behind a large map
  const std::vector<MountedResource>& resources;
  std::function<void(const std::shared_ptr<HttpSession>&)> on_close;
  std::function<bool()> has_room_without_token;  ///< for one more request whose caller nobody vouches for
};

/// Held by shared_ptr: handlers that are still queued keep it alive. context: the server's thread only.
class HttpSession : public std::enable_shared_from_this<HttpSession> {
 public:
  using Socket = boost::asio::ip::tcp::socket;

  /// number: of the connection since the server's start.
  HttpSession(const HttpSessionHost& host, Socket socket, std::uint64_t number);

  void start();
  /// Answers with 503 and closes: there are too many connections.
  void turn_away();
  /// Checks the waiting request again: a job changed.
  void resume() { check_wait(false); }
  /// The same at the daemon's end, which answers it in any case, and ends a stream.
  void end_wait_now();
  /// Answers what waits for the worker too, which does not come back in time: calls that wait, and what is fetched, if
  /// nothing of it was sent yet.
  void give_up();
  /// What a connection has at work, which says when it gives way to another one.
  enum class AtWork { kNothing, kLogIn, kAnswer };
  /// kAnswer: from a whole request of a known caller to the last byte of its answer; it never gives way.
  [[nodiscard]] AtWork at_work() const noexcept { return state_; }
  /// True if the request, or the latest one, came with a token.
  [[nodiscard]] bool has_token() const noexcept { return head_.authorization.has_value(); }
  /// When it became as it is: of those with the same at work the oldest gives way first.
  [[nodiscard]] HostTime since() const noexcept { return since_; }
  /// Closes at once and calls the host's on_close.
  void close();

 private:
  using ErrorCodeOf = boost::system::error_code;
  using Parser = boost::beast::http::request_parser<boost::beast::http::string_body>;
  using Response = boost::beast::http::response<boost::beast::http::string_body>;

  /// A GET or HEAD, from its header to the end of its answer.
  struct Fetch {
    HttpResource* resource = nullptr;
    ResourceRequest request;
    HostTime begun{};
    std::shared_ptr<BodySource> source{};    ///< of what is still to be sent
    std::uint64_t left_bytes = 0;            ///< that the source owes
    std::unique_ptr<StreamSource> stream{};  ///< in its place
    bool keep_alive = true;                  ///< the connection, after the answer
    bool is_put_off = false;                 ///< until wait_ is over
    bool is_made = false;                    ///< by the worker: nothing of the answer was sent
    bool owes_ping = false;                  ///< of the stream
  };
  /// The next bytes of a body; nothing where they cannot be had.
  using Piece = std::optional<std::string>;

  void await_request();
  void read_head();
  /// The one place that says which path and method has which handler.
  void take_head(ErrorCodeOf error);
  /// The header of POST /api/jsonrpc: its body is read if it may be.
  void serve_call();
  void read_body();
  void take_body(ErrorCodeOf error);
  /// Finds out who the caller is, then answers.
  void recognise();
  void refuse_token(const std::string& why);
  /// Tells the log, unless it was just told of one from there. details: for the log alone, below the alarms.
  void note_refusal(const std::string& why, const std::string& details = {});
  /// Whatever the known caller asks for.
  void answer();
  void take(Handled handled);
  void begin_wait(WaitingRequest waiting);
  void check_wait(bool timed_out);
  void end_wait(std::optional<std::string> reply);
  /// Closes when the client does, which nobody would see during a wait otherwise; until end_request(). A request behind
  /// this one stays unread and hides that end; behind a stream, which no request follows, input is dropped, and closes
  /// where it is much.
  void watch_client();
  /// Runs `what`, which may block, on a worker, then the member `then` with its result on the server's thread.
  template <typename Result>
  void work(Worker& worker, std::function<Result()> what, void (HttpSession::*then)(Result)) {
    on_worker_ = true;
    worker.post([self = shared_from_this(), what = std::move(what), then]() mutable {
      Result result = what();
      boost::asio::io_context& context = self->host_.context;
      // The session is moved back: its destructor must run on the server's thread.
      boost::asio::post(context, [self = std::move(self), result = std::move(result), then]() mutable {
        self->on_worker_ = false;
        if (!self->is_closed_) (self.get()->*then)(std::move(result));
      });
    });
  }
  void take_identity(std::pair<std::optional<Identity>, std::string> found);

  // What is fetched: http_session_get.cpp.
  /// The header of a GET or HEAD.
  void serve_get();
  [[nodiscard]] ResourceRequest resource_request() const;
  /// Asks the resource on its worker.
  void fetch();
  void take_answer(std::shared_ptr<ResourceAnswer> answer);
  /// Asks again later.
  void put_off(std::chrono::milliseconds time);
  void send_answer(ResourceAnswer answer);
  /// Sends a header, if there is one, and the bytes behind it, then goes on.
  void send_piece(std::string head, std::string bytes);
  void go_on();
  void take_piece(Piece piece);
  /// Sends what the stream has, now and whenever it has more.
  void begin_stream();
  void pump();
  void time_ping();

  /// 200 with a reply of JSON-RPC, 204 without one.
  void send_reply(std::optional<std::string> reply);
  void refuse(const HttpRefusal& refusal);
  /// The daemon's: with 503.
  void refuse_at_end();
  /// Why reading failed, if the client can still be told; else closes.
  void refuse_unread(ErrorCodeOf error);
  void send(Response response);
  /// Nothing of the request is needed any more.
  void end_request();
  /// True where the request's answer may have no body.
  [[nodiscard]] bool is_head() const;
  /// Lets the client read the answer, then closes: to close with unread input would discard it.
  void drain();
  /// Whatever is under way ends then with timed_out_ set.
  void expire_after(std::chrono::milliseconds time);

  const HttpSessionHost& host_;
  Socket socket_;
  Caller caller_;
  Identity by_address_;  ///< who the caller is without a token
  std::string address_;  ///< of the other end
  std::string own_address_;
  boost::asio::steady_timer deadline_;
  boost::asio::steady_timer wait_;
  boost::beast::flat_buffer buffer_;
  std::optional<Parser> parser_;  ///< of the request that is read or answered
  HttpHead head_;
  Response response_;
  std::optional<Fetch> fetch_;
  std::string head_text_;  ///< that is being sent, as the next
  std::string piece_;
  bool is_sending_ = false;  ///< these two
  std::optional<WaitingRequest> waiting_;
  HostTime since_ = HostClock::now();
  std::uint64_t watches_ = 0;  ///< of the client, that began
  std::uint64_t watch_ = 0;    ///< the one that counts; 0 = none
  std::size_t behind_stream_bytes_ = 0;
  AtWork state_ = AtWork::kNothing;
  bool timed_out_ = false;
  bool wait_is_over_ = false;
  bool on_worker_ = false;    ///< a worker runs a task of this session, one at a time
  bool check_again_ = false;  ///< a check was asked for during a check
  bool is_ending_ = false;    ///< the daemon is
  bool is_closed_ = false;
};

}  // namespace fvd
