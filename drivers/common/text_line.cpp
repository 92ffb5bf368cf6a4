#include "drivers/common/text_line.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <netdb.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <termios.h>
#include <unistd.h>

#include "core/base/error.hpp"

namespace fvd {

namespace {

constexpr std::size_t kMaxAnswerBytes = 4096;

speed_t speed_of(int baud) {
  constexpr std::pair<int, speed_t> kSpeeds[] = {
      {9600, B9600}, {19200, B19200}, {38400, B38400}, {57600, B57600}, {115200, B115200}};
  for (const auto& [rate, speed] : kSpeeds) {
    if (rate == baud) return speed;
  }
  throw Error(ErrorCode::kBadConfig, std::to_string(baud) + " baud: expected one of 9600, 19200, 38400, 57600, 115200");
}

int open_serial(const TextLineConfig& config, std::string& error) {
  const speed_t speed = speed_of(config.serial_baud);
  const int fd = ::open(config.serial_device.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  termios settings{};
  // No second program on the line: its answers would be taken for ours.
  if (fd < 0 || ::tcgetattr(fd, &settings) != 0 || ::ioctl(fd, TIOCEXCL) != 0) {
    error = std::strerror(errno);
    if (fd >= 0) ::close(fd);
    return -1;
  }
  ::cfmakeraw(&settings);
  settings.c_cflag |= CLOCAL | CREAD;
  settings.c_cflag &= ~static_cast<tcflag_t>(CSTOPB | CRTSCTS);
  if (::cfsetspeed(&settings, speed) != 0 || ::tcsetattr(fd, TCSANOW, &settings) != 0) {
    error = std::strerror(errno);
    ::close(fd);
    return -1;
  }
  ::tcflush(fd, TCIOFLUSH);
  return fd;
}

/// A socket that is connecting; -1 and why if the host has no address.
int begin_connect(const TextLineConfig& config, std::string& error) {
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  const int failed = ::getaddrinfo(config.host.c_str(), std::to_string(config.port).c_str(), &hints, &found);
  if (failed != 0) {
    error = ::gai_strerror(failed);
    return -1;
  }
  const int fd = ::socket(found->ai_family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  const bool begun = fd >= 0 && (::connect(fd, found->ai_addr, found->ai_addrlen) == 0 || errno == EINPROGRESS);
  if (!begun) {
    error = std::strerror(errno);
    if (fd >= 0) ::close(fd);
  }
  ::freeaddrinfo(found);
  return begun ? fd : -1;
}

}  // namespace

TextLine::TextLine(const TextLineConfig& config) : config_(config) {
  std::string error;
  if (open(error)) return;
  throw Error(ErrorCode::kStageDisconnected, "no connection to the device at " + description() + ": " + error +
                                                 "; is it switched on and its address right?");
}

TextLine::~TextLine() { close(); }

bool TextLine::wait(short events, HostTime deadline) const {
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - HostClock::now()).count();
  pollfd waiting{fd_, events, 0};
  return left > 0 && ::poll(&waiting, 1, static_cast<int>(left)) > 0;
}

bool TextLine::has_input() const {
  pollfd looked_at{fd_, POLLIN, 0};
  return ::poll(&looked_at, 1, 0) > 0;
}

bool TextLine::open(std::string& error) {
  unread_.clear();
  fd_ = config_.serial_device.empty() ? begin_connect(config_, error) : open_serial(config_, error);
  if (fd_ < 0) return false;
  if (!config_.serial_device.empty()) {
    if (doubtful_) drain();
    return true;
  }
  int failure = ETIMEDOUT;
  socklen_t size = sizeof(failure);
  if (wait(POLLOUT, HostClock::now() + config_.response_timeout)) {
    ::getsockopt(fd_, SOL_SOCKET, SO_ERROR, &failure, &size);
  }
  if (failure != 0) {
    error = std::strerror(failure);
    close();
    return false;
  }
  const int on = 1;
  ::setsockopt(fd_, IPPROTO_TCP, TCP_NODELAY, &on, sizeof(on));
  return true;
}

void TextLine::close() noexcept {
  if (fd_ >= 0) ::close(fd_);
  fd_ = -1;
}

/// Until the line was silent for as long as an answer may take.
void TextLine::drain() {
  constexpr int kMostReads = 64;
  std::array<char, 512> chunk{};
  for (int i = 0; i < kMostReads && wait(POLLIN, HostClock::now() + config_.response_timeout); ++i) {
    if (::read(fd_, chunk.data(), chunk.size()) <= 0) break;
  }
}

bool TextLine::send(std::string_view text, HostTime deadline, std::string& error) {
  while (!text.empty()) {
    const auto sent = config_.serial_device.empty() ? ::send(fd_, text.data(), text.size(), MSG_NOSIGNAL)
                                                    : ::write(fd_, text.data(), text.size());
    if (sent > 0) text.remove_prefix(static_cast<std::size_t>(sent));
    if (sent > 0 || errno == EINTR) continue;
    if (errno != EAGAIN || !wait(POLLOUT, deadline)) {
      error = std::strerror(errno);
      return false;
    }
  }
  return true;
}

std::optional<std::string> TextLine::receive(HostTime deadline, std::string& error) {
  for (std::size_t searched = 0;;) {
    const auto feed = unread_.find('\n', searched);
    if (feed != std::string::npos) {
      searched = feed + 1;
      if (feed > 0 && config_.continuation != '\0' && unread_[feed - 1] == config_.continuation) continue;
      std::string answer = unread_.substr(0, feed);
      unread_.erase(0, feed + 1);
      return answer;
    }
    if (unread_.size() > kMaxAnswerBytes) {
      error = "an answer without an end";
      return std::nullopt;
    }
    if (!wait(POLLIN, deadline)) {
      error = "no answer within " + std::to_string(config_.response_timeout.count()) + " ms";
      return std::nullopt;
    }
    std::array<char, 512> chunk{};
    const auto count = ::read(fd_, chunk.data(), chunk.size());
    if (count > 0) unread_.append(chunk.data(), static_cast<std::size_t>(count));
    if (count == 0 || (count < 0 && errno != EAGAIN && errno != EINTR)) {
      error = count == 0 ? "the connection was closed" : std::strerror(errno);
      return std::nullopt;
    }
  }
}

void TextLine::begin(bool urgent) {
  MutexLock lock(mutex_);
  if (urgent) ++urgent_;
  turn_.wait(lock, [&] {
    mutex_.assert_held();
    return !taken_ && (urgent || urgent_ == 0);
  });
  if (urgent) --urgent_;
  taken_ = true;
}

void TextLine::end(bool answered) {
  {
    const MutexLock lock(mutex_);
    taken_ = false;
    ++statistics_.exchanges;
    if (!answered) ++statistics_.unanswered;
  }
  turn_.notify_all();
}

std::optional<std::vector<std::string>> TextLine::exchange(std::string_view text, int count, std::string& error,
                                                           bool urgent) {
  begin(urgent);
  std::optional<std::vector<std::string>> answers;
  // What came since the last exchange answers no question that is still to be asked.
  if (fd_ >= 0 && !urgent && has_input()) {  // a stop goes out whatever the line has said
    close();
    doubtful_ = true;
  }
  if (fd_ < 0) {
    const MutexLock lock(mutex_);
    ++statistics_.reopenings;
  }
  if (fd_ >= 0 || open(error)) {
    const HostTime deadline = HostClock::now() + config_.response_timeout;
    answers.emplace();
    bool sound = send(text, deadline, error);
    while (sound && static_cast<int>(answers->size()) < count) {
      auto answer = receive(deadline, error);
      sound = answer.has_value();
      if (sound) answers->push_back(std::move(*answer));
    }
    if (sound && !unread_.empty()) {
      error = "an answer that nobody asked for";
      sound = false;
    }
    if (!sound) {
      answers.reset();
      close();
      doubtful_ = true;
    }
  }
  end(answers.has_value());
  return answers;
}

TextLine::Statistics TextLine::statistics() const {
  const MutexLock lock(mutex_);
  return statistics_;
}

std::string TextLine::description() const {
  return config_.serial_device.empty() ? config_.host + ":" + std::to_string(config_.port) : config_.serial_device;
}

}  // namespace fvd
