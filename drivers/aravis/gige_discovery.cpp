/// Who answers a GVCP discovery.

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <memory>
#include <span>
#include <utility>

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include "core/base/clock.hpp"
#include "drivers/aravis/camera_search.hpp"

namespace fvd {

namespace {

using std::chrono::milliseconds;

constexpr std::uint16_t kGvcpPort = 3956;
constexpr std::size_t kHeaderBytes = 8;
/// The payload of an answer is laid out as the bootstrap registers (GigE Vision 1.2, section 15).
constexpr std::size_t kAnswerBytes = 0xF8;
constexpr std::size_t kMac = 0x0A;
constexpr std::size_t kIp = 0x24;
constexpr std::size_t kVendor = 0x48;
constexpr std::size_t kModel = 0x68;
constexpr std::size_t kVersion = 0x88;
constexpr std::size_t kSerial = 0xD8;
constexpr std::size_t kUserName = 0xE8;
constexpr milliseconds kRepeatInterval{200};
/// Once the wanted camera has answered, another one of that name has this long to do so too.
constexpr milliseconds kForOthers{100};

class Socket {
 public:
  Socket() : fd_(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)) {}
  ~Socket() {
    if (fd_ >= 0) ::close(fd_);
  }
  Socket(Socket&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;
  Socket& operator=(Socket&&) = delete;
  [[nodiscard]] int get() const { return fd_; }

 private:
  int fd_;
};

/// A socket and where its request goes.
struct Question {
  Socket socket;
  in_addr to{};
};

/// The socket of an interface sends from its address, which makes the limited broadcast leave there.
std::vector<Question> on_every_interface() {
  std::vector<Question> questions;
  ifaddrs* list = nullptr;
  if (::getifaddrs(&list) != 0) return questions;
  const std::unique_ptr<ifaddrs, decltype(&::freeifaddrs)> owner(list, &::freeifaddrs);
  for (const ifaddrs* each = list; each != nullptr; each = each->ifa_next) {
    if (each->ifa_addr == nullptr || each->ifa_addr->sa_family != AF_INET || (each->ifa_flags & IFF_UP) == 0) continue;
    Question question;
    sockaddr_in own = *reinterpret_cast<const sockaddr_in*>(each->ifa_addr);
    own.sin_port = 0;
    const int on = 1;
    ::setsockopt(question.socket.get(), SOL_SOCKET, SO_BROADCAST, &on, sizeof on);
    if (::bind(question.socket.get(), reinterpret_cast<const sockaddr*>(&own), sizeof own) != 0) continue;
    question.to.s_addr = htonl(INADDR_BROADCAST);
    questions.push_back(std::move(question));
  }
  return questions;
}

std::vector<Question> at(const std::string& address) {
  Question question;
  const int on = 1;
  ::setsockopt(question.socket.get(), SOL_SOCKET, SO_BROADCAST, &on, sizeof on);
  std::vector<Question> questions;
  if (::inet_pton(AF_INET, address.c_str(), &question.to) == 1) questions.push_back(std::move(question));
  return questions;
}

void send(const Question& question) {
  // DISCOVERY: an acknowledge is wanted, also by broadcast.
  constexpr std::array<std::uint8_t, kHeaderBytes> kRequest{0x42, 0x11, 0x00, 0x02, 0x00, 0x00, 0x00, 0x01};
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(kGvcpPort);
  to.sin_addr = question.to;
  ::sendto(question.socket.get(), kRequest.data(), kRequest.size(), MSG_NOSIGNAL,
           reinterpret_cast<const sockaddr*>(&to), sizeof to);
}

/// Text of fixed length, which a zero ends early.
std::string text_of(std::span<const std::uint8_t> bytes) {
  const auto end = std::find(bytes.begin(), bytes.end(), std::uint8_t{0});
  return {bytes.begin(), end};
}

std::optional<FoundCamera> read_answer(std::span<const std::uint8_t> answer) {
  const bool is_one = answer.size() >= kHeaderBytes + kAnswerBytes && answer[0] == 0 && answer[1] == 0 &&
                      answer[2] == 0x00 && answer[3] == 0x03;
  if (!is_one) return std::nullopt;
  const auto fields = answer.subspan(kHeaderBytes);
  FoundCamera camera;
  std::array<char, 18> mac{};
  std::snprintf(mac.data(), mac.size(), "%02x:%02x:%02x:%02x:%02x:%02x", fields[kMac], fields[kMac + 1],
                fields[kMac + 2], fields[kMac + 3], fields[kMac + 4], fields[kMac + 5]);
  camera.mac = mac.data();
  std::array<char, INET_ADDRSTRLEN> ip{};
  ::inet_ntop(AF_INET, &fields[kIp], ip.data(), ip.size());
  camera.ip = ip.data();
  camera.vendor = text_of(fields.subspan(kVendor, 32));
  camera.model = text_of(fields.subspan(kModel, 32));
  camera.version = text_of(fields.subspan(kVersion, 32));
  camera.serial = text_of(fields.subspan(kSerial, 16));
  camera.user_name = text_of(fields.subspan(kUserName, 16));
  return camera;
}

/// Adds what has arrived at the socket. A camera that several interfaces reach answers more than once.
void collect(const Question& question, std::vector<FoundCamera>& cameras) {
  std::array<std::uint8_t, 1024> bytes{};
  for (;;) {
    const ssize_t size = ::recv(question.socket.get(), bytes.data(), bytes.size(), MSG_DONTWAIT);
    if (size < 0 && errno == ECONNREFUSED) continue;
    if (size < 0) return;
    auto camera = read_answer(std::span(bytes).first(static_cast<std::size_t>(size)));
    if (!camera) continue;
    const bool known = std::any_of(cameras.begin(), cameras.end(), [&](const FoundCamera& one) {
      return one.mac == camera->mac && one.ip == camera->ip;
    });
    if (!known) cameras.push_back(*std::move(camera));
  }
}

std::vector<FoundCamera> ask(const std::vector<Question>& questions, milliseconds patience, const std::string& wanted) {
  std::vector<FoundCamera> cameras;
  HostTime deadline = HostClock::now() + patience;
  HostTime next_request{};
  bool found = false;
  while (HostClock::now() < deadline) {
    if (HostClock::now() >= next_request) {
      for (const Question& question : questions) send(question);
      next_request = HostClock::now() + kRepeatInterval;
    }
    std::vector<pollfd> waiting;
    for (const Question& question : questions) waiting.push_back({question.socket.get(), POLLIN, 0});
    const auto left = std::chrono::ceil<milliseconds>(std::min(deadline, next_request) - HostClock::now());
    ::poll(waiting.data(), waiting.size(), std::max(0, static_cast<int>(left.count())));
    for (const Question& question : questions) collect(question, cameras);
    if (found || wanted.empty()) continue;
    found = std::any_of(cameras.begin(), cameras.end(), [&](const FoundCamera& one) { return one.is_called(wanted); });
    if (found) deadline = std::min(deadline, HostClock::now() + kForOthers);
  }
  return cameras;
}

}  // namespace

std::optional<FoundCamera> identify_camera(const std::string& ip, milliseconds patience) {
  HostTime deadline = HostClock::now() + patience;
  const auto questions = at(ip);
  std::vector<FoundCamera> cameras;
  while (cameras.empty() && HostClock::now() < deadline) {
    if (questions.empty()) return std::nullopt;
    send(questions.front());
    pollfd waiting{questions.front().socket.get(), POLLIN, 0};
    ::poll(&waiting, 1, static_cast<int>(kRepeatInterval.count() / 4));
    collect(questions.front(), cameras);
  }
  if (cameras.empty()) return std::nullopt;
  cameras.front().ip = ip;
  return cameras.front();
}

std::vector<FoundCamera> search_cameras(const std::string& search_address, milliseconds patience,
                                        const std::string& wanted) {
  return ask(search_address.empty() ? on_every_interface() : at(search_address), patience, wanted);
}

}  // namespace fvd
