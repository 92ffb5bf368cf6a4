#include "drivers/aravis/gvcp_probe.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <initializer_list>
#include <span>
#include <utility>
#include <vector>

#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include "core/base/error.hpp"
#include "drivers/gige/gvcp_socket.hpp"

namespace fvd {

namespace {

constexpr std::uint16_t kGvcpPort = 3956;
constexpr std::uint32_t kControl = 0x02;
constexpr std::uint32_t kControlOrExclusive = 0x03;

std::uint16_t next_id(std::uint16_t id) { return static_cast<std::uint16_t>(id == 0xFFFF ? 1 : id + 1); }

/// A command that wants an acknowledge.
std::vector<std::uint8_t> command(std::uint16_t code, std::uint16_t id, std::initializer_list<std::uint32_t> words) {
  std::vector<std::uint8_t> payload;
  for (const std::uint32_t word : words) gvcp::put32(payload, word);
  return gvcp::command(code, gvcp::kAcknowledged, id, payload);
}

struct Received {
  bool refused = false;  ///< by the host: nothing listens there
  gvcp::Acknowledge ack{};
};

/// The next datagram, without waiting; nothing if there is none.
std::optional<Received> receive(int fd) {
  for (;;) {
    std::array<std::uint8_t, 64> bytes{};
    const ssize_t size = ::recv(fd, bytes.data(), bytes.size(), MSG_DONTWAIT);
    if (size < 0) return errno == ECONNREFUSED ? std::optional(Received{.refused = true}) : std::nullopt;
    auto ack = gvcp::acknowledge_of(std::span(bytes).first(static_cast<std::size_t>(size)));
    if (ack) return Received{false, std::move(*ack)};
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
  const auto request = command(gvcp::kReadRegister, last_id_, {gvcp::kControlPrivilege});
  // A refusal of an earlier datagram may be reported here, in place of sending.
  for (int i = 0; i < 2 && ::send(fd_, request.data(), request.size(), MSG_NOSIGNAL) < 0; ++i) continue;
}

GvcpProbe::Answer GvcpProbe::look() noexcept {
  while (const auto received = receive(fd_)) {
    if (received->refused) return Answer::kAbsent;
    const gvcp::Acknowledge& ack = received->ack;
    const bool ours =
        static_cast<std::uint16_t>(ack.request - first_id_) <= static_cast<std::uint16_t>(last_id_ - first_id_);
    if (!ours) continue;
    if (ack.code == gvcp::kPendingAck) pending_until_ = HostClock::now() + ack.pending();
    if (ack.code != gvcp::kReadRegister + 1) continue;
    // One that refuses to tell is there all the same.
    if (ack.status != 0) return Answer::kTellsNothing;
    if (ack.payload.size() < 4) continue;  // damaged; no value is not the value 0
    return (gvcp::get32(ack.payload, 0) & kControlOrExclusive) != 0 ? Answer::kControlled : Answer::kFree;
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
  const auto request = command(gvcp::kWriteRegister, last_id_, {gvcp::kControlPrivilege, value});
  if (::send(fd_, request.data(), request.size(), MSG_NOSIGNAL) < 0) return std::nullopt;
  sent_ = HostClock::now();
  while (HostClock::now() < deadline) {
    wait(deadline);
    while (const auto received = receive(fd_)) {
      const gvcp::Acknowledge& ack = received->ack;
      if (!received->refused && ack.request == last_id_ && ack.code == gvcp::kWriteRegister + 1) return ack.status;
    }
    sent_ = HostClock::now();
  }
  return std::nullopt;
}

bool GvcpProbe::control_denied(std::chrono::milliseconds patience) noexcept {
  const auto status = write_privilege(kControl, HostClock::now() + patience);
  if (status == 0) (void)write_privilege(0, HostClock::now() + patience);
  return status == gvcp::kAccessDenied;
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
