#include "daemon/transport/http_session.hpp"

#include <algorithm>
#include <array>

#include <boost/asio/write.hpp>

#include "core/base/error.hpp"
#include "daemon/access/access_error.hpp"
#include "daemon/transport/http_fields.hpp"
#include "daemon/transport/http_message.hpp"
#include "daemon/transport/http_routes.hpp"
#include "daemon/transport/paced_drop.hpp"
#include "daemon/transport/reading_time.hpp"
#include "daemon/transport/tcp_options.hpp"

namespace fvd {

namespace asio = boost::asio;
namespace http = boost::beast::http;

namespace {

constexpr const char* kCallPath = "/api/jsonrpc";
constexpr std::uint32_t kMaxHeader_bytes = 16384;
constexpr std::size_t kMaxBody_bytes = std::size_t{1} << 20U;
/// Of a body that is read; its beginning may have come with the header.
constexpr std::size_t kReadChunk_bytes = std::size_t{64} << 10U;
constexpr std::chrono::seconds kHeaderTime{10};
constexpr std::chrono::seconds kBodyTime{10};
constexpr std::chrono::seconds kKeepAliveTime{60};  // between two requests
constexpr std::chrono::seconds kDrainTime{1};
/// Of what a reader of a stream says, which is for nobody.
constexpr std::size_t kMostBehindStream_bytes = std::size_t{1} << 20U;

/// Without a token nobody can change anything by HTTP, whatever his address may do elsewhere: a page in a browser has
/// that address too.
Identity looking_only(Identity who) {
  who.role = std::min(who.role, Role::kView);
  return who;
}

}  // namespace

HttpSession::HttpSession(const HttpSessionHost& host, Socket socket, std::uint64_t number)
    : host_(host),
      socket_(std::move(socket)),
      deadline_(host.context),
      wait_(host.context),
      buffer_(kMaxHeader_bytes + kReadChunk_bytes) {
  ErrorCodeOf gone;
  address_ = socket_.remote_endpoint(gone).address().to_string(gone);
  own_address_ = socket_.local_endpoint(gone).address().to_string(gone);
  caller_.connection = number;
  caller_.peer = "http " + peer_of(socket_.native_handle());
  by_address_ = {"address " + address_, Role::kNone};
  if (const auto bytes = address_bytes(address_)) by_address_ = looking_only(host.access.of_address(*bytes, address_));
}

void HttpSession::start() {
  tune(socket_.native_handle());
  read_head();
}

void HttpSession::turn_away() {
  tune(socket_.native_handle());
  refuse({503, "too_many_connections", "too many connections; close some, or try again later"});
}

void HttpSession::close() {
  if (is_closed_) return;
  is_closed_ = true;
  waiting_.reset();
  fetch_.reset();
  ErrorCodeOf ignored;
  deadline_.cancel();
  wait_.cancel();
  socket_.shutdown(Socket::shutdown_both, ignored);
  socket_.close(ignored);
  host_.on_close(shared_from_this());
}

void HttpSession::expire_after(std::chrono::milliseconds time) {
  timed_out_ = false;
  deadline_.expires_after(time);
  deadline_.async_wait([self = shared_from_this()](ErrorCodeOf error) {
    // One that was put off after it had expired comes all the same.
    if (error || self->is_closed_ || self->deadline_.expiry() > std::chrono::steady_clock::now()) return;
    self->timed_out_ = true;
    ErrorCodeOf ignored;
    self->socket_.cancel(ignored);
  });
}

void HttpSession::await_request() {
  state_ = AtWork::kNothing;
  since_ = HostClock::now();
  if (buffer_.size() > 0) return read_head();
  expire_after(kKeepAliveTime);
  socket_.async_wait(Socket::wait_read, [self = shared_from_this()](ErrorCodeOf error) {
    if (self->is_closed_) return;
    // What came in the moment of the deadline completes without an error, here and in all that follows.
    if (error || self->timed_out_) return self->close();
    self->read_head();
  });
}

void HttpSession::read_head() {
  parser_.emplace();
  parser_->header_limit(kMaxHeader_bytes);
  parser_->body_limit(kMaxBody_bytes);
  expire_after(kHeaderTime);
  http::async_read_header(socket_, buffer_, *parser_, [self = shared_from_this()](ErrorCodeOf error, std::size_t) {
    if (!self->is_closed_) self->take_head(error);
  });
}

void HttpSession::take_head(ErrorCodeOf error) {
  if (error || timed_out_) return refuse_unread(error);
  head_ = head_of(parser_->get());
  if (const auto refusal = host_.gate.refusal_of(head_, own_address_)) {
    note_refusal(refusal->error);
    return refuse(*refusal);
  }
  // Beast knows a body's end where `chunked` is the last coding alone. What a body of another coding would be must not
  // be read here as the next request.
  if (parser_->get().count(http::field::transfer_encoding) > 0 && !parser_->chunked()) {
    return refuse({400, "bad_request", "send a body with Content-Length, or with Transfer-Encoding: chunked alone"});
  }
  const http::verb method = parser_->get().method();
  const bool is_get = method == http::verb::get || method == http::verb::head;
  if (head_.path == kCallPath) {
    if (method == http::verb::post) return serve_call();
    return refuse({405, "method_not_allowed", "use POST", "POST"});
  }
  if (is_get) return serve_get();
  if (resource_for(host_.resources, head_.path) == nullptr) {
    return refuse({404, "not_found", std::string("there is nothing here; calls go to POST ") + kCallPath});
  }
  refuse({405, "method_not_allowed", std::string("use GET; calls go to POST ") + kCallPath, "GET, HEAD"});
}

void HttpSession::serve_call() {
  if (!head_.content_type || !is_json_type(*head_.content_type)) {
    return refuse({415, "unsupported_media_type", "send the header field Content-Type: application/json"});
  }
  if (parser_->get()[http::field::expect] != "100-continue") return read_body();
  static const std::string kContinue = "HTTP/1.1 100 Continue\r\n\r\n";
  asio::async_write(socket_, asio::buffer(kContinue), [self = shared_from_this()](ErrorCodeOf error, std::size_t) {
    if (self->is_closed_) return;
    if (error || self->timed_out_) return self->close();
    self->read_body();
  });
}

void HttpSession::read_body() {
  expire_after(kBodyTime);
  http::async_read(socket_, buffer_, *parser_, [self = shared_from_this()](ErrorCodeOf error, std::size_t) {
    if (!self->is_closed_) self->take_body(error);
  });
}

void HttpSession::take_body(ErrorCodeOf error) {
  if (error || timed_out_) return refuse_unread(error);
  deadline_.cancel();
  since_ = HostClock::now();
  caller_.received = HostClock::now();
  recognise();
}

void HttpSession::recognise() {
  if (!head_.authorization) {
    if (!host_.has_room_without_token()) {
      return refuse({503, "too_many_connections",
                     "too many callers without a token wait for an answer; send a token, or try again later"});
    }
    caller_.who = by_address_;
    return answer();
  }
  const auto token = bearer_of(*head_.authorization);
  if (!token) return refuse_token("Authorization is not of the form Bearer TOKEN");
  state_ = AtWork::kLogIn;
  using Found = std::pair<std::optional<Identity>, std::string>;
  work<Found>(
      host_.logins,
      [&access = host_.access, token = std::string(*token)]() -> Found {
        try {
          return {access.of_token(token), {}};
        } catch (const TokensUnreadable& error) {
          return {std::nullopt, error.reason()};
        }
      },
      &HttpSession::take_identity);
}

void HttpSession::take_identity(std::pair<std::optional<Identity>, std::string> found) {
  if (!found.second.empty()) {
    const std::string why =
        "nobody can be recognised by a token: the file of tokens cannot be read; the log of fvd says why";
    note_refusal(why, found.second);
    return refuse({503, "no_tokens", why});
  }
  if (!found.first) return refuse_token("nobody has this token");
  caller_.who = *std::move(found.first);
  answer();
}

void HttpSession::refuse_token(const std::string& why) {
  state_ = AtWork::kNothing;
  const auto delay = host_.wrong_tokens.delay_of_another(address_, HostClock::now());
  note_refusal(why);
  since_ = HostClock::now();
  wait_.expires_after(delay);
  wait_.async_wait([self = shared_from_this(), why](ErrorCodeOf error) {
    if (error || self->is_closed_) return;
    self->refuse({401, "unauthorized", why + "; fvdctl token new makes one, which goes into rpc.token_file"});
  });
}

void HttpSession::note_refusal(const std::string& why, const std::string& details) {
  host_.refused_calls.tell(by_address_.name, "HTTP from " + caller_.peer + " was refused: " + why, details);
}

void HttpSession::answer() {
  state_ = AtWork::kAnswer;
  if (fetch_) return fetch();
  const std::string& text = parser_->get().body();
  // What is longer than any line is a document, whose reading alone would keep this thread from others.
  if (text.size() <= Dispatcher::kMaxLineBytes) {
    if (auto handled = host_.dispatcher.try_handle(text, caller_)) return take(std::move(*handled));
  }
  work<Handled>(
      host_.worker,
      [&dispatcher = host_.dispatcher, text, caller = caller_] { return dispatcher.handle(text, caller); },
      &HttpSession::take);
}

void HttpSession::take(Handled handled) {
  if (handled.waiting) return begin_wait(*std::move(handled.waiting));
  send_reply(std::move(handled.reply));
}

void HttpSession::begin_wait(WaitingRequest waiting) {
  wait_is_over_ = false;
  wait_.expires_after(waiting.until.timeout);
  waiting_ = std::move(waiting);
  wait_.async_wait([self = shared_from_this()](ErrorCodeOf error) {
    if (!error && self->wait_.expiry() <= std::chrono::steady_clock::now()) self->check_wait(true);
  });
  watch_client();
  check_wait(false);
}

void HttpSession::watch_client() {
  watch_ = ++watches_;
  socket_.async_wait(Socket::wait_read, [self = shared_from_this(), watch = watch_](ErrorCodeOf error) {
    // What ends the watch of a request that was answered is the next request.
    if (error || self->is_closed_ || watch != self->watch_) return;
    ErrorCodeOf gone;
    if (self->socket_.available(gone) == 0) return self->close();
    // Behind a stream comes no other request: what is sent all the same would hide the client's end.
    if (!self->fetch_ || !self->fetch_->stream) return;
    std::array<char, 4096> dropped{};
    self->behind_stream_bytes_ += self->socket_.read_some(asio::buffer(dropped), gone);
    if (gone || self->behind_stream_bytes_ > kMostBehindStream_bytes) return self->close();
    self->watch_client();
  });
}

void HttpSession::end_wait_now() {
  is_ending_ = true;
  if (fetch_ && fetch_->stream) return close();
  if (fetch_ && fetch_->is_put_off) return refuse_at_end();
  check_wait(false);
}

void HttpSession::give_up() {
  if (waiting_) return end_wait(host_.dispatcher.ended(*waiting_));
  // What comes back from the worker finds no request then.
  if (fetch_ && fetch_->is_made) refuse_at_end();
}

void HttpSession::refuse_at_end() { refuse({503, "shutting_down", "the daemon stops; ask again when it is back"}); }

void HttpSession::check_wait(bool timed_out) {
  if (!waiting_) return;
  wait_is_over_ = wait_is_over_ || timed_out;
  if (on_worker_) {
    check_again_ = true;
    return;
  }
  if (!wait_is_over_ && !host_.dispatcher.may_have_come(*waiting_)) {
    if (is_ending_) end_wait(std::nullopt);
    return;
  }
  check_again_ = false;
  work<std::optional<std::string>>(
      host_.worker,
      [&dispatcher = host_.dispatcher, waiting = *waiting_, late = wait_is_over_] {
        return dispatcher.resume(waiting, late);
      },
      &HttpSession::end_wait);
}

void HttpSession::end_wait(std::optional<std::string> reply) {
  if (!reply && is_ending_) reply = host_.dispatcher.ended(*waiting_);
  if (!reply) {
    if (check_again_) check_wait(false);
    return;
  }
  waiting_.reset();
  wait_.cancel();
  send_reply(std::move(reply));
}

void HttpSession::send_reply(std::optional<std::string> reply) {
  Response response;
  response.result(reply ? http::status::ok : http::status::no_content);
  if (reply) response.body() = *std::move(reply) + "\n";
  response.keep_alive(parser_->get().keep_alive());
  send(std::move(response));
}

void HttpSession::refuse_unread(ErrorCodeOf error) {
  if (timed_out_) {
    const bool is_begun = parser_ && (buffer_.size() > 0 || parser_->got_some());
    if (!is_begun) return close();
    return refuse({408, "too_slow", "the request did not come within 10 s; send it at once"});
  }
  if (error == http::error::header_limit) {
    return refuse({431, "header_too_large", "the header has more than 16 KiB; send fewer fields"});
  }
  if (error == http::error::body_limit) {
    return refuse(
        {413, "too_large", "the body has more than " + std::to_string(kMaxBody_bytes) + " bytes; send less at a time"});
  }
  const bool is_http = error.category() == http::make_error_code(http::error::bad_method).category();
  if (!is_http || error == http::error::end_of_stream || error == http::error::partial_message) return close();
  refuse({400, "bad_request", "this is no HTTP/1.1: " + error.message() + "; see POST /api/jsonrpc"});
}

void HttpSession::refuse(const HttpRefusal& refusal) {
  Response response;
  response.result(static_cast<unsigned>(refusal.status));
  if (refusal.status == 401) response.set(http::field::www_authenticate, "Bearer");
  if (!refusal.allow.empty()) response.set(http::field::allow, refusal.allow);
  response.body() = refusal.body();
  response.keep_alive(false);
  send(std::move(response));
}

void HttpSession::send(Response response) {
  set_common_fields(response);
  response.set(http::field::cache_control, "no-store");
  if (!response.body().empty()) response.set(http::field::content_type, "application/json");
  if (response.result() != http::status::no_content) response.prepare_payload();
  if (is_head()) response.body().clear();  // the length stays
  end_request();
  response_ = std::move(response);
  expire_after(reading_time(response_.body().size()));
  http::async_write(socket_, response_, [self = shared_from_this()](ErrorCodeOf error, std::size_t) {
    if (self->is_closed_) return;
    if (error || self->timed_out_) return self->close();
    if (self->response_.keep_alive()) return self->await_request();
    self->drain();
  });
}

bool HttpSession::is_head() const {
  return parser_ && parser_->is_header_done() && parser_->get().method() == http::verb::head;
}

void HttpSession::end_request() {
  watch_ = 0;
  fetch_.reset();
  wait_.cancel();
}

void HttpSession::drain() {
  state_ = AtWork::kNothing;
  ErrorCodeOf ignored;
  socket_.shutdown(Socket::shutdown_send, ignored);
  // expire_after() ends what is under way; between two reads nothing is.
  deadline_.expires_after(kDrainTime);
  deadline_.async_wait([self = shared_from_this()](ErrorCodeOf error) {
    if (!error) self->close();
  });
  drop_at_a_pace(socket_, wait_, [self = shared_from_this()] { self->close(); });
}

}  // namespace fvd
