#include "daemon/transport/rpc_session.hpp"

#include <algorithm>
#include <string_view>
#include <utility>

#include <boost/asio/post.hpp>
#include <boost/asio/write.hpp>

#include "daemon/transport/foreign_protocol.hpp"
#include "daemon/transport/paced_drop.hpp"
#include "daemon/transport/tcp_options.hpp"

namespace fvd {

namespace asio = boost::asio;

namespace {

/// Limit of the replies that a client has not read; beyond it the connection is closed.
constexpr std::size_t kMaxUnsentBytes = 1U << 20U;
/// Of one of them, so that others fit beside it.
constexpr std::size_t kLongestReply_bytes = kMaxUnsentBytes - Dispatcher::kMaxLineBytes;
/// Limit of consecutive lines that are no JSON: such a client speaks another protocol.
constexpr int kMaxParseErrorsInARow = 3;
/// A line waits for its turn after so many tries, unless it is urgent, which is tried again for another job alone: with
/// a client's many waits and lines, no work by their product.
constexpr int kMostLooks = 4;
constexpr std::string_view kTerminators("\n\r\0", 3);
constexpr std::chrono::milliseconds kLongestLineEnd{3000};  // from a text to its end: networks repeat what they lose
constexpr std::chrono::seconds kRefusalGrace{1};            // for a refused client to read the reason

}  // namespace

template <typename Result>
void RpcSession::work(Worker& worker, std::function<Result(const Dispatcher&)> what, void (RpcSession::*then)(Result)) {
  at_work_ = true;
  worker.post([self = shared_from_this(), what = std::move(what), then]() mutable {
    Result result = what(self->host_.dispatcher);
    asio::io_context& context = self->host_.context;
    // The session is moved back: its destructor must run on the network thread.
    asio::post(context, [self = std::move(self), result = std::move(result), then]() mutable {
      self->at_work_ = false;
      if (!self->refused_) (self.get()->*then)(std::move(result));
    });
  });
}

RpcSession::RpcSession(const RpcSessionHost& host, Socket socket, Caller caller)
    : host_(host),
      socket_(std::move(socket)),
      caller_(std::move(caller)),
      idle_(host.context),
      wait_(host.context),
      line_end_(host.context),
      drop_(host.context) {
  caller_.longest_reply_bytes = kLongestReply_bytes;
}

void RpcSession::start(bool must_log_in) {
  must_log_in_ = must_log_in;
  tune(socket_.native_handle());
  watch_idle();
  read();
}

void RpcSession::refuse(std::string reason) {
  tune(socket_.native_handle());
  refuse_with(std::move(reason));
  read();
}

void RpcSession::resume(bool timed_out) {
  check_wait(timed_out);
  process();
}

void RpcSession::end_waits() {
  ending_ = true;
  resume(false);
}

void RpcSession::give_up() {
  if (!waiting_) return;
  send(host_.dispatcher.ended(*waiting_));
  waiting_.reset();
}

void RpcSession::close() {
  refused_ = true;
  waiting_.reset();
  ErrorCodeOf ignored;
  idle_.cancel();
  wait_.cancel();
  line_end_.cancel();
  drop_.cancel();
  socket_.shutdown(Socket::shutdown_both, ignored);
  socket_.close(ignored);
  host_.on_close(shared_from_this());
}

void RpcSession::watch_idle() {
  if (is_accepted_) {
    idle_.expires_after(host_.idle_timeout);
  } else {
    idle_.expires_at(begun_ + std::min(host_.first_request, host_.idle_timeout));
  }
  idle_.async_wait([self = shared_from_this()](ErrorCodeOf error) {
    // A connection with an open request is not idle; the request has a timeout of its own.
    // One that expired while a request was answered was put off meanwhile: its handler comes all the same.
    const bool put_off = self->idle_.expiry() > std::chrono::steady_clock::now();
    if (!error && !put_off && !self->has_request()) self->close();
  });
}

void RpcSession::read() {
  socket_.async_read_some(asio::buffer(chunk_), [self = shared_from_this()](ErrorCodeOf error, std::size_t count) {
    if (error == asio::error::eof && !self->refused_) return self->half_close();
    if (error) return self->close();
    if (!self->refused_) {
      self->receive({self->chunk_.data(), count});
      self->watches_end_ = false;
      self->process();
    }
    if (self->refused_) return drop_at_a_pace(self->socket_, self->drop_, [self] { self->close(); });
    self->read();
  });
}

void RpcSession::receive(std::string_view bytes) {
  const HostTime now = HostClock::now();
  input_.append(bytes);
  std::size_t begin = 0;
  for (;;) {
    const std::size_t end = input_.find_first_of(kTerminators, begin);
    if (end == std::string::npos) break;
    std::string line = input_.substr(begin, end - begin);
    begin = end + 1;
    if (line.find_first_not_of(" \t") == std::string::npos) {
      watch_idle();
      continue;
    }
    line_bytes_ += line.size();
    lines_.push_back({std::move(line), input_[end] == '\0' ? LineEnd::kNul : LineEnd::kBreak, now});
  }
  input_.erase(0, begin);
}

void RpcSession::half_close() {
  half_closed_ = true;
  close_if_all_is_said();
}

void RpcSession::close_if_all_is_said() {
  if (!half_closed_ || refused_ || has_request()) return;
  if (input_.find_first_not_of(" \t") != std::string::npos)
    return refuse_with(Dispatcher::mistaken(missing_end(input_)));
  if (unsent_.empty()) close();
}

void RpcSession::process() {
  while (!has_request() && !refused_ && !lines_.empty()) {
    const Line line = std::move(lines_.front());
    lines_.pop_front();
    line_bytes_ -= line.text.size();
    if (looked_at_ > 0) --looked_at_;
    if (line.text.size() > Dispatcher::kMaxLineBytes) return refuse_with(Dispatcher::too_long());
    if (begins_foreign_protocol(line.text)) return refuse_with(Dispatcher::foreign_protocol());
    if (const auto mistake = mistake_in(line.text, line.end)) return refuse_with(Dispatcher::mistaken(*mistake));
    if (must_log_in_ && !host_.dispatcher.is_log_in(line.text)) return refuse_with(Dispatcher::too_many_connections());
    watch_idle();
    caller_.received = line.received;
    if (auto handled = host_.dispatcher.try_handle(line.text, caller_)) {
      take(std::move(*handled));
    } else {
      work<Handled>(
          worker_for(line.text),
          [text = line.text, caller = caller_](const Dispatcher& dispatcher) {
            return dispatcher.handle(text, caller);
          },
          &RpcSession::take_and_go_on);
    }
  }
  if (refused_) return;
  if (has_request()) overtake();
  if (refused_) return;
  // Also limits the input that collects behind an open request.
  if (line_bytes_ + input_.size() > Dispatcher::kMaxLineBytes) return refuse_with(Dispatcher::too_long());
  if (has_request()) return;
  // What has a length has no end.
  if (const auto mistake = mistake_in(input_, LineEnd::kNone)) return refuse_with(Dispatcher::mistaken(*mistake));
  watch_line_end();
  close_if_all_is_said();
}

Worker& RpcSession::worker_for(std::string_view line) const {
  if (host_.dispatcher.is_log_in(line)) return host_.logins;
  return host_.dispatcher.is_long(line) ? host_.lists : host_.worker;
}

void RpcSession::watch_line_end() {
  if (watches_end_ || input_.empty() || half_closed_) return;
  watches_end_ = true;
  // Before a connection without a valid request is closed without a word.
  const std::chrono::milliseconds first_request = host_.first_request;
  line_end_.expires_after(is_accepted_ ? kLongestLineEnd : std::min(kLongestLineEnd, first_request / 2));
  line_end_.async_wait([self = shared_from_this()](ErrorCodeOf error) {
    if (error || self->line_end_.expiry() > std::chrono::steady_clock::now()) return;
    self->watches_end_ = false;
    if (self->refused_ || self->has_request() || self->input_.empty()) return;
    if (nlohmann::json::accept(self->input_)) self->refuse_with(Dispatcher::mistaken(missing_end(self->input_)));
  });
}

void RpcSession::overtake() {
  const auto behind = waiting_ ? Dispatcher::Behind::kWait : Dispatcher::Behind::kWork;
  std::optional<std::string> board;
  while (!refused_ && looked_at_ < lines_.size()) {
    const auto line = lines_.begin() + static_cast<std::ptrdiff_t>(looked_at_);
    if (!std::exchange(line->is_read, true)) {
      line->is_mistaken = begins_foreign_protocol(line->text) || mistake_in(line->text, line->end);
      if (!line->is_mistaken) line->overtaker = host_.dispatcher.overtaker(line->text);
    }
    // A line of another protocol is refused when its turn comes, and nothing behind it is read.
    if (line->is_mistaken) return;
    auto handled = answer_early(*line, behind, board);
    if (!handled) {
      ++looked_at_;
      continue;
    }
    line_bytes_ -= line->text.size();
    lines_.erase(line);
    if (handled->reply) send(std::move(*handled->reply));
  }
}

std::optional<Handled> RpcSession::answer_early(Line& line, Dispatcher::Behind behind,
                                                std::optional<std::string>& board) const {
  if (line.overtaker == nullptr || !Dispatcher::may_overtake(*line.overtaker, caller_, behind)) return std::nullopt;
  if (line.overtaker->about.is_urgent) {
    if (!board) board = host_.dispatcher.job_on_board();
    if (line.board == board) return std::nullopt;
    line.board = board;
  } else if (line.looks++ >= kMostLooks) {
    return std::nullopt;
  }
  Caller caller = caller_;
  caller.received = line.received;
  return host_.dispatcher.try_handle(line.text, caller);
}

void RpcSession::take(Handled handled) {
  const bool has_logged_in = handled.log_in.has_value();
  if (has_logged_in) caller_.who = *std::move(handled.log_in);
  if (must_log_in_) {
    if (!has_logged_in && handled.reply) send(std::move(*handled.reply));
    if (!has_logged_in || !host_.has_room(caller_.who)) return refuse_with(Dispatcher::too_many_connections());
    must_log_in_ = false;
  }
  is_accepted_ = is_accepted_ || handled.is_accepted;
  watch_idle();
  parse_errors_in_a_row_ = handled.is_parse_error ? parse_errors_in_a_row_ + 1 : 0;
  if (parse_errors_in_a_row_ == kMaxParseErrorsInARow) return refuse_with(Dispatcher::no_json());
  if (handled.reply) send(std::move(*handled.reply));
  if (handled.waiting && !refused_) begin_wait(std::move(*handled.waiting));
}

void RpcSession::take_and_go_on(Handled handled) {
  take(std::move(handled));
  process();
}

void RpcSession::begin_wait(WaitingRequest waiting) {
  timed_out_ = false;
  looked_at_ = 0;  // more may overtake a wait
  wait_.expires_after(waiting.until.timeout);
  waiting_ = std::move(waiting);
  wait_.async_wait([self = shared_from_this()](ErrorCodeOf error) {
    // An expiry that was already queued when the wait ended must not end the next wait.
    if (!error && self->wait_.expiry() <= std::chrono::steady_clock::now()) self->resume(true);
  });
  check_wait(false);
}

void RpcSession::check_wait(bool timed_out) {
  if (!waiting_) return;
  timed_out_ = timed_out_ || timed_out;
  if (at_work_) {
    check_again_ = true;
    return;
  }
  if (!timed_out_ && !host_.dispatcher.may_have_come(*waiting_)) {
    if (ending_) end_wait(std::nullopt);
    return;
  }
  check_again_ = false;
  work<std::optional<std::string>>(
      host_.worker,
      [waiting = *waiting_, late = timed_out_](const Dispatcher& dispatcher) {
        return dispatcher.resume(waiting, late);
      },
      &RpcSession::end_wait);
}

void RpcSession::end_wait(std::optional<std::string> reply) {
  if (!reply && ending_) reply = host_.dispatcher.ended(*waiting_);
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

void RpcSession::refuse_with(std::string line) {
  refused_ = true;
  input_.clear();
  lines_.clear();
  send(std::move(line));
  idle_.expires_after(kRefusalGrace);
  idle_.async_wait([self = shared_from_this()](ErrorCodeOf error) {
    if (!error) self->close();
  });
}

void RpcSession::send(std::string line) {
  line += '\n';
  unsent_bytes_ += line.size();
  unsent_.push_back(std::move(line));
  if (unsent_bytes_ > kMaxUnsentBytes) return close();
  if (unsent_.size() == 1) write();
}

void RpcSession::write() {
  asio::async_write(socket_, asio::buffer(unsent_.front()),
                    [self = shared_from_this()](ErrorCodeOf error, std::size_t count) {
                      if (error) return self->close();
                      self->unsent_bytes_ -= count;
                      self->unsent_.pop_front();
                      if (!self->unsent_.empty()) return self->write();
                      if (self->refused_ && self->half_closed_) return self->close();
                      ErrorCodeOf ignored;
                      if (self->refused_) self->socket_.shutdown(Socket::shutdown_send, ignored);
                      self->close_if_all_is_said();
                    });
}

}  // namespace fvd
