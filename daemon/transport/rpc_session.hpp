#pragma once

/// One connection of a client: lines in, replies out, one open request at a time.

#include <array>
#include <chrono>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>  // before Asio 1.74, which forgets it

#include <boost/asio/generic/stream_protocol.hpp>
#include <boost/asio/steady_timer.hpp>

#include "daemon/api/dispatcher.hpp"
#include "daemon/transport/line_mistakes.hpp"
#include "daemon/transport/worker.hpp"

namespace fvd {

class RpcSession;

/// What a session needs of its server; all of it outlives the session.
struct RpcSessionHost {
  boost::asio::io_context& context;  ///< run by the network thread
  const Dispatcher& dispatcher;
  Worker& worker;
  Worker& logins;  ///< nobody waits behind a slow call to be recognised
  Worker& lists;   ///< no start and no result waits behind what people look through
  std::chrono::seconds idle_timeout;
  std::chrono::seconds first_request;  ///< a connection without a valid request is closed after it
  std::function<void(const std::shared_ptr<RpcSession>&)> on_close;
  std::function<bool(const Identity&)> has_room;  ///< for a connection that has just logged in
};

/// Held by shared_ptr: handlers that are still queued keep it alive. context: the network thread only.
class RpcSession : public std::enable_shared_from_this<RpcSession> {
 public:
  using Socket = boost::asio::generic::stream_protocol::socket;

  /// caller: who is at the other end, as the connection tells.
  RpcSession(const RpcSessionHost& host, Socket socket, Caller caller);

  /// Serves the client from now on. must_log_in: there is no place but for who may control, which it has to show by its
  /// first request.
  void start(bool must_log_in);
  /// Tells the client a reason, a whole reply, and closes after it.
  void refuse(std::string reason);
  /// The daemon ends: what waits is answered, with an error where nothing else is to be said.
  void end_waits();
  /// Answers what waits for the worker too, which does not come back in time.
  void give_up();
  /// Checks the waiting request again: a job changed, or the waiting time is over.
  void resume(bool timed_out);
  /// True if every request was answered and every reply was sent.
  [[nodiscard]] bool is_answered() const noexcept { return !has_request() && unsent_.empty(); }
  [[nodiscard]] const Caller& caller() const noexcept { return caller_; }
  /// True if nothing is answered any more.
  [[nodiscard]] bool is_refused() const noexcept { return refused_; }
  /// True if it takes no place yet.
  [[nodiscard]] bool must_log_in() const noexcept { return must_log_in_; }
  /// True if the client closed its sending side.
  [[nodiscard]] bool is_half_closed() const noexcept { return half_closed_; }
  /// Closes at once and calls the host's on_close.
  void close();

 private:
  using ErrorCodeOf = boost::system::error_code;

  struct Line {
    std::string text;
    LineEnd end = LineEnd::kBreak;
    HostTime received;  ///< when its end came, however long it waits then

    bool is_read = false;                ///< overtake() has looked into it, and found the next two
    bool is_mistaken = false;            ///< nothing behind it is executed
    const Method* overtaker = nullptr;   ///< of a request that may overtake others; null = it waits for its turn
    int looks = 0;                       ///< so often it was tried in vain; not of what is urgent
    std::optional<std::string> board{};  ///< of what is urgent: the job on the board when it was tried in vain
  };

  /// Restarts the idle timeout; an unfinished line does not restart it, an empty one does.
  void watch_idle();
  void read();
  /// Cuts what has come into lines.
  void receive(std::string_view bytes);
  /// The client closed its sending side; its open requests are still answered.
  void half_close();
  void close_if_all_is_said();
  /// True while a request is open: on the worker, or waiting for a job or the devices.
  [[nodiscard]] bool has_request() const noexcept { return at_work_ || waiting_.has_value(); }
  /// Runs `what`, which may block, on a worker, then the member `then` with its result on the network thread.
  template <typename Result>
  void work(Worker& worker, std::function<Result(const Dispatcher&)> what, void (RpcSession::*then)(Result));
  /// Handles the whole lines at hand, in order; stops at a request that cannot be answered at once.
  void process();
  /// That a line is handled by.
  [[nodiscard]] Worker& worker_for(std::string_view line) const;
  /// A whole text whose end does not come gets a line that says so.
  void watch_line_end();
  /// Answers requests that stand behind an open one and may overtake it.
  void overtake();
  /// The answer to one of them; nothing if it may not, or cannot yet. board: the job on the board, once it was asked
  /// for.
  [[nodiscard]] std::optional<Handled> answer_early(Line& line, Dispatcher::Behind behind,
                                                    std::optional<std::string>& board) const;
  void take(Handled handled);
  void take_and_go_on(Handled handled);
  void begin_wait(WaitingRequest waiting);
  /// Checks on the worker whether the waiting request can be answered; a check during a check is made after it.
  void check_wait(bool timed_out);
  void end_wait(std::optional<std::string> reply);
  /// Sends the reason and closes the connection after it.
  void refuse_with(std::string line);
  void send(std::string line);
  void write();

  const RpcSessionHost& host_;
  Socket socket_;
  Caller caller_;
  const std::chrono::steady_clock::time_point begun_ = std::chrono::steady_clock::now();
  boost::asio::steady_timer idle_;
  boost::asio::steady_timer wait_;
  boost::asio::steady_timer line_end_;
  boost::asio::steady_timer drop_;  // of what comes after a refusal
  std::array<char, 4096> chunk_{};
  std::string input_;           // the beginning of a line whose end has not come
  std::deque<Line> lines_;      // that wait for their turn; none is blank
  std::size_t line_bytes_ = 0;  // of lines_
  std::size_t looked_at_ = 0;   // so many of lines_ hold no request that may overtake
  std::deque<std::string> unsent_;
  std::size_t unsent_bytes_ = 0;
  std::optional<WaitingRequest> waiting_;
  bool at_work_ = false;      // a worker runs a task of this session, one at a time
  bool timed_out_ = false;    // of waiting_
  bool check_again_ = false;  // a check was asked for during a check
  bool half_closed_ = false;
  bool watches_end_ = false;  // of input_, since its last bytes came
  bool ending_ = false;       // the daemon ends: nothing waits any more
  bool must_log_in_ = false;
  bool is_accepted_ = false;  // it has made a valid request
  bool refused_ = false;
  int parse_errors_in_a_row_ = 0;
};

}  // namespace fvd
