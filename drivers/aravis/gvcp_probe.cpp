#include "drivers/aravis/gvcp_probe.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include "core/base/error.hpp"

namespace fvd {

namespace {

constexpr std::uint16_t kGvcpPort = 3956;
constexpr std::size_t kHeaderBytes = 8;
constexpr std::uint8_t kControlOrExclusive = 0x03;

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
  first_id_ = last_id_ = static_cast<std::uint16_t>(last_id_ == 0xFFFF ? 1 : last_id_ + 1);
  send();
}

void GvcpProbe::send() noexcept {
  sent_ = HostClock::now();
  // READREG: key, acknowledge wanted, command, length, request id, address of CCP.
  const std::array<std::uint8_t, 12> request{0x42,
                                             0x01,
                                             0x00,
                                             0x80,
                                             0x00,
                                             0x04,
                                             static_cast<std::uint8_t>(last_id_ >> 8U),
                                             static_cast<std::uint8_t>(last_id_ & 0xFFU),
                                             0x00,
                                             0x00,
                                             0x0A,
                                             0x00};
  // A refusal of an earlier datagram may be reported here, in place of sending.
  for (int i = 0; i < 2 && ::send(fd_, request.data(), request.size(), MSG_NOSIGNAL) < 0; ++i) continue;
}

GvcpProbe::Answer GvcpProbe::look() noexcept {
  for (;;) {
    std::array<std::uint8_t, 64> ack{};
    const ssize_t size = ::recv(fd_, ack.data(), ack.size(), MSG_DONTWAIT);
    if (size < 0) {
      if (errno == ECONNREFUSED) return Answer::kAbsent;
      break;
    }
    const auto id = static_cast<std::uint16_t>((ack[6] << 8U) | ack[7]);
    const bool ours = static_cast<std::size_t>(size) >= kHeaderBytes && ack[2] == 0x00 && ack[3] == 0x81 &&
                      static_cast<std::uint16_t>(id - first_id_) <= static_cast<std::uint16_t>(last_id_ - first_id_);
    if (!ours) continue;
    // One that refuses to tell is there all the same.
    const bool told = ack[0] == 0 && ack[1] == 0 && static_cast<std::size_t>(size) >= kHeaderBytes + 4;
    return !told || (ack[11] & kControlOrExclusive) != 0 ? Answer::kControlled : Answer::kFree;
  }
  if (HostClock::now() - sent_ >= kRepeatInterval) {
    ++last_id_;
    send();
  }
  return Answer::kNone;
}

GvcpProbe::Answer GvcpProbe::ask(std::chrono::milliseconds patience) noexcept {
  begin();
  const HostTime deadline = HostClock::now() + patience;
  for (;;) {
    const Answer answer = look();
    if (answer != Answer::kNone || HostClock::now() >= deadline) return answer;
    wait(std::min(deadline, sent_ + kRepeatInterval));
  }
}

void GvcpProbe::wait(HostTime until) const noexcept {
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(until - HostClock::now());
  pollfd readable{fd_, POLLIN, 0};
  if (left.count() > 0) ::poll(&readable, 1, static_cast<int>(left.count()));
}

}  // namespace fvd
