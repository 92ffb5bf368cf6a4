#pragma once

/// A line to a device that speaks text, TCP or serial: one exchange at a time, each of which ends.

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/clock.hpp"
#include "core/base/mutex.hpp"

namespace fvd {

/// Rates that a serial line may have.
inline constexpr int kTextLineBauds[] = {9600, 19200, 38400, 57600, 115200};

struct TextLineConfig {
  std::string host = "127.0.0.1";  ///< unless there is a serial_device
  int port = 50000;
  std::string serial_device;
  int serial_baud = 115200;  ///< one of kTextLineBauds; 8 bits, no parity, one stop bit
  std::chrono::milliseconds response_timeout{200};
  char continuation = '\0';  ///< an answer whose line ends with this character goes on in the next; 0 = none does
};

/// Answers end with a line feed. After a doubt - no answer in time, a broken line - the line is opened anew before the
/// next exchange: no late answer is taken for one to a later question; on a serial line that takes one response timeout
/// of silence. context: thread-safe; urgent callers go first, so one waits for one exchange at most.
class TextLine {
 public:
  /// Opens the line. Throws Error kStageDisconnected naming it and the reason.
  explicit TextLine(const TextLineConfig& config);
  ~TextLine();
  TextLine(const TextLine&) = delete;
  TextLine& operator=(const TextLine&) = delete;

  /// Sends the text as it is and reads `count` answers, without their last line feeds; nothing, and why, if they did
  /// not all come in time. Text without answers has count 0.
  [[nodiscard]] std::optional<std::vector<std::string>> exchange(std::string_view text, int count, std::string& error,
                                                                 bool urgent = false);

  struct Statistics {
    std::uint64_t exchanges = 0;
    std::uint64_t unanswered = 0;
    std::uint64_t reopenings = 0;
  };
  [[nodiscard]] Statistics statistics() const;
  [[nodiscard]] std::string description() const;

 private:
  void begin(bool urgent);
  void end(bool answered);
  bool open(std::string& error);
  void close() noexcept;
  bool send(std::string_view text, HostTime deadline, std::string& error);
  std::optional<std::string> receive(HostTime deadline, std::string& error);
  void drain();
  bool wait(short events, HostTime deadline) const;
  [[nodiscard]] bool has_input() const;  ///< or the end of the connection

  const TextLineConfig config_;
  int fd_ = -1;  // of the caller whose turn it is, as the two below
  std::string unread_;
  bool doubtful_ = false;  // likewise: a late answer may come
  mutable Mutex mutex_;
  Condition turn_;
  bool taken_ FVD_GUARDED_BY(mutex_) = false;
  int urgent_ FVD_GUARDED_BY(mutex_) = 0;  // callers that wait and go first
  Statistics statistics_ FVD_GUARDED_BY(mutex_);
};

}  // namespace fvd
