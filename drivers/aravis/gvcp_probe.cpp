#include "drivers/aravis/gvcp_probe.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <initializer_list>
#include <vector>

#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include "core/base/error.hpp"

namespace fvd {

namespace {

constexpr std::uint16_t kGvcpPort = 3956;
constexpr std::size_t kHeaderBytes = 8;
constexpr std::uint16_t kReadRegister = 0x0080;
constexpr std::uint16_t kWriteRegister = 0x0082;
constexpr std::uint16_t kPendingAck = 0x0089;
constexpr std::uint16_t kAccessDenied = 0x8006;
constexpr std::uint32_t kControlPrivilege = 0x0A00;  // the register's address
constexpr std::uint32_t kControl = 0x02;
constexpr std::uint32_t kControlOrExclusive = 0x03;

std::uint16_t next_id(std::uint16_t id) { return static_cast<std::uint16_t>(id == 0xFFFF ? 1 : id + 1); }

/// A command that wants an acknowledge.
std::vector<std::uint8_t> command(std::uint16_t code, std::uint16_t id, std::initializer_list<std::uint32_t> words) {
  std::vector<std::uint8_t> bytes{0x42, 0x01};
  const auto put = [&bytes](std::uint32_t value, unsigned count) {
    while (count-- > 0) bytes.push_back(static_cast<std::uint8_t>(value >> (8U * count)));
  };
  put(code, 2);
  put(static_cast<std::uint32_t>(4 * words.size()), 2);
  put(id, 2);
  for (const std::uint32_t word : words) put(word, 4);
  return bytes;
}

struct Acknowledge {
  bool refused = false;  ///< by the host: nothing listens there
  std::uint16_t status = 0;
  std::uint16_t command = 0;
  std::uint16_t id = 0;
  std::uint32_t value = 0;  ///< first word of the payload, 0 if there is none
};

/// The next datagram, without waiting; nothing if there is none.
std::optional<Acknowledge> receive(int fd) {
  for (;;) {
    std::array<std::uint8_t, 64> bytes{};
    const ssize_t size = ::recv(fd, bytes.data(), bytes.size(), MSG_DONTWAIT);
    if (size < 0) return errno == ECONNREFUSED ? std::optional(Acknowledge{.refused = true}) : std::nullopt;
    if (static_cast<std::size_t>(size) < kHeaderBytes) continue;
    const auto number = [&bytes](std::size_t at) {
      return static_cast<std::uint16_t>((bytes[at] << 8U) | bytes[at + 1]);
    };
    return Acknowledge{false, number(0), number(2), number(6),
                       (static_cast<std::uint32_t>(number(8)) << 16U) | number(10)};
  }
}

}  // namespace

GvcpProbe::GvcpProbe(const std::string& ip) : fd_(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)) {
  sockaddr_in camera{};
  camera.sin_family = AF_INET;
  camera.sin_port = htons(kGvcpPort);
  // Connected, so that the host's "port unreachable" comes back as an error.
  if (fd_ >= 0 && ::inet_pton(AF_INET, ip.c_str(), &camera.sin_addr) == 1 &&
      ::connect(fd_, reinterpret_cast<const sockaddr*>(&camera), sizeof camera) == 0) {
    return;
  }
  const std::string reason = std::strerror(errno);
  if (fd_ >= 0) ::close(fd_);
  throw Error(ErrorCode::kCameraDisconnected, "no way to a camera at " + ip + ": " + reason + "; check the network");
}

GvcpProbe::~GvcpProbe() { ::close(fd_); }

void GvcpProbe::begin() noexcept {
  first_id_ = last_id_ = next_id(last_id_);
  pending_until_ = {};
  send();
}

void GvcpProbe::send() noexcept {
  sent_ = HostClock::now();
  const auto request = command(kReadRegister, last_id_, {kControlPrivilege});
  // A refusal of an earlier datagram may be reported here, in place of sending.
  for (int i = 0; i < 2 && ::send(fd_, request.data(), request.size(), MSG_NOSIGNAL) < 0; ++i) continue;
}

GvcpProbe::Answer GvcpProbe::look() noexcept {
  while (const auto ack = receive(fd_)) {
    if (ack->refused) return Answer::kAbsent;
    const bool ours =
        static_cast<std::uint16_t>(ack->id - first_id_) <= static_cast<std::uint16_t>(last_id_ - first_id_);
    if (!ours) continue;
    if (ack->command == kPendingAck) {
      pending_until_ = HostClock::now() + std::chrono::milliseconds(ack->value & 0xFFFFU);
      continue;
    }
    if (ack->command != kReadRegister + 1) continue;
    // One that refuses to tell is there all the same.
    if (ack->status != 0) return Answer::kTellsNothing;
    return (ack->value & kControlOrExclusive) != 0 ? Answer::kControlled : Answer::kFree;
  }
  if (HostClock::now() - sent_ >= kRepeatInterval) {
    ++last_id_;
    send();
  }
  return Answer::kNone;
}

/// The status of the acknowledge; nothing if none came.
std::optional<std::uint16_t> GvcpProbe::write_privilege(std::uint32_t value, HostTime deadline) noexcept {
  first_id_ = last_id_ = next_id(last_id_);
  const auto request = command(kWriteRegister, last_id_, {kControlPrivilege, value});
  if (::send(fd_, request.data(), request.size(), MSG_NOSIGNAL) < 0) return std::nullopt;
  sent_ = HostClock::now();
  while (HostClock::now() < deadline) {
    wait(deadline);
    while (const auto ack = receive(fd_)) {
      if (!ack->refused && ack->id == last_id_ && ack->command == kWriteRegister + 1) return ack->status;
    }
    sent_ = HostClock::now();
  }
  return std::nullopt;
}

bool GvcpProbe::control_denied(std::chrono::milliseconds patience) noexcept {
  const auto status = write_privilege(kControl, HostClock::now() + patience);
  if (status == 0) (void)write_privilege(0, HostClock::now() + patience);
  return status == kAccessDenied;
}

GvcpProbe::Answer GvcpProbe::ask(std::chrono::milliseconds patience) noexcept {
  begin();
  const HostTime deadline = HostClock::now() + patience;
  for (;;) {
    const Answer answer = look();
    if (answer != Answer::kNone || HostClock::now() >= deadline) return answer;
    wait(deadline);
  }
}

void GvcpProbe::wait(HostTime until) const noexcept {
  const auto left =
      std::chrono::ceil<std::chrono::milliseconds>(std::min(until, sent_ + kRepeatInterval) - HostClock::now());
  pollfd readable{fd_, POLLIN, 0};
  if (left.count() > 0) ::poll(&readable, 1, static_cast<int>(left.count()));
}

}  // namespace fvd
