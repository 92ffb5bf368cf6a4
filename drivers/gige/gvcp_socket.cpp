#include "drivers/gige/gvcp_socket.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <sstream>
#include <thread>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/uio.h>
#include <unistd.h>

#include "core/base/error.hpp"

namespace fvd {

namespace {

using SteadyClock = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr std::uint16_t kPort = 3956;
constexpr std::size_t kHeaderBytes = 8;
constexpr std::uint32_t kKey = 0x42;
constexpr int kAttempts = 3;
constexpr milliseconds kPatience{200};
/// A camera that is busy for longer refuses the command; it is asked again after pauses that grow up to kPatience.
constexpr milliseconds kLongestBusy{2000};
constexpr milliseconds kFirstPause{10};
/// Most datagrams that are read after the wait is over.
constexpr int kMostLate = 256;

std::string refusal(std::uint16_t status) {
  std::ostringstream text;
  text << "status 0x" << std::hex << status;
  if (status == gvcp::kAccessDenied) text << ", access denied: another program controls it";
  if (status == gvcp::kBusy) text << ", it stays busy";
  if (status == 0x8003) text << ", it has no such register";
  if (status == 0x8004) text << ", the register is write-protected";
  return text.str();
}

}  // namespace

void gvcp::put32(std::vector<std::uint8_t>& bytes, std::uint32_t value) {
  for (const unsigned shift : {24U, 16U, 8U, 0U}) bytes.push_back(static_cast<std::uint8_t>((value >> shift) & 0xFFU));
}

std::string gvcp::address_text(std::uint32_t address) {
  const in_addr binary{htonl(address)};
  std::array<char, INET_ADDRSTRLEN> text{};
  ::inet_ntop(AF_INET, &binary, text.data(), text.size());
  return text.data();
}

std::optional<std::uint32_t> gvcp::address_of(const std::string& text) {
  in_addr binary{};
  if (::inet_pton(AF_INET, text.c_str(), &binary) != 1) return std::nullopt;
  return ntohl(binary.s_addr);
}

std::vector<std::uint8_t> gvcp::command(std::uint16_t code, std::uint8_t flags, std::uint16_t request,
                                        std::span<const std::uint8_t> payload) {
  std::vector<std::uint8_t> bytes;
  put32(bytes, kKey << 24U | std::uint32_t{flags} << 16U | code);
  put32(bytes, static_cast<std::uint32_t>(payload.size()) << 16U | request);
  bytes.insert(bytes.end(), payload.begin(), payload.end());
  return bytes;
}

std::optional<gvcp::Acknowledge> gvcp::acknowledge_of(std::span<const std::uint8_t> datagram) {
  if (datagram.size() < kHeaderBytes) return std::nullopt;
  const auto number = [&](std::size_t at) { return static_cast<std::uint16_t>(get32(datagram, at) >> 16U); };
  return Acknowledge{number(0),
                     number(2),
                     static_cast<std::uint16_t>(get32(datagram, 4) & 0xFFFFU),
                     {datagram.begin() + kHeaderBytes, datagram.end()}};
}

milliseconds gvcp::Acknowledge::pending() const {
  return milliseconds(payload.size() < 4 ? 0 : get32(payload, 0) & 0xFFFFU);
}

GvcpSocket::GvcpSocket(std::uint32_t local, int interface_index)
    : fd_(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)),
      local_(local),
      interface_index_(interface_index) {
  const int on = 1;
  if (fd_ >= 0 && ::setsockopt(fd_, SOL_SOCKET, SO_BROADCAST, &on, sizeof on) == 0) return;
  const std::string reason = std::strerror(errno);
  if (fd_ >= 0) ::close(fd_);
  throw Error(ErrorCode::kCameraDisconnected, "no socket to ask cameras with: " + reason);
}

GvcpSocket::~GvcpSocket() { ::close(fd_); }

std::uint16_t GvcpSocket::send(std::uint32_t to, std::uint16_t command, std::uint8_t flags,
                               std::span<const std::uint8_t> payload) {
  last_request_ = static_cast<std::uint16_t>(last_request_ == 0xFFFF ? 1 : last_request_ + 1);  // never 0
  if (!send_datagram(to, gvcp::command(command, flags, last_request_, payload))) {
    throw Error(ErrorCode::kCameraDisconnected,
                "nothing can be sent to " + gvcp::address_text(to) + ": " + std::strerror(errno));
  }
  return last_request_;
}

bool GvcpSocket::send_datagram(std::uint32_t to, std::span<const std::uint8_t> bytes) {
  sockaddr_in where{};
  where.sin_family = AF_INET;
  where.sin_addr.s_addr = htonl(to);
  where.sin_port = htons(kPort);
  std::vector<std::uint8_t> copy(bytes.begin(), bytes.end());
  iovec content{copy.data(), copy.size()};
  alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(in_pktinfo))> control{};
  msghdr message{};
  message.msg_name = &where;
  message.msg_namelen = sizeof where;
  message.msg_iov = &content;
  message.msg_iovlen = 1;
  if (local_ != 0) {  // else a datagram to everybody leaves through the interface of the default route only
    message.msg_control = control.data();
    message.msg_controllen = control.size();
    cmsghdr* const header = CMSG_FIRSTHDR(&message);
    header->cmsg_level = IPPROTO_IP;
    header->cmsg_type = IP_PKTINFO;
    header->cmsg_len = CMSG_LEN(sizeof(in_pktinfo));
    in_pktinfo through{};
    through.ipi_ifindex = interface_index_;
    through.ipi_spec_dst.s_addr = htonl(local_);
    std::memcpy(CMSG_DATA(header), &through, sizeof through);
  }
  return ::sendmsg(fd_, &message, MSG_NOSIGNAL) >= 0;
}

std::optional<gvcp::Acknowledge> GvcpSocket::receive(std::uint16_t command, std::uint16_t request,
                                                     SteadyClock::time_point until) {
  for (int late = 0; late < kMostLate;) {
    const bool over = SteadyClock::now() >= until;
    if (over) ++late;
    std::array<std::uint8_t, 1024> bytes{};
    const ssize_t size = ::recv(fd_, bytes.data(), bytes.size(), 0);
    if (size < 0 && over) return std::nullopt;
    if (size < 0) {
      const auto left = std::chrono::ceil<milliseconds>(until - SteadyClock::now());
      pollfd readable{fd_, POLLIN, 0};
      if (left.count() > 0) ::poll(&readable, 1, static_cast<int>(left.count()));
      continue;
    }
    auto ack = gvcp::acknowledge_of(std::span(bytes).first(static_cast<std::size_t>(size)));
    if (!ack || (request != 0 && ack->request != request)) continue;
    if (ack->code == command + 1) return ack;
    if (ack->code == gvcp::kPendingAck && request != 0) until = std::max(until, SteadyClock::now() + ack->pending());
  }
  return std::nullopt;
}

/// The acknowledge of a command that may be repeated; nothing if none came.
std::optional<gvcp::Acknowledge> GvcpSocket::ask(std::uint32_t camera, std::uint16_t command,
                                                 std::span<const std::uint8_t> payload) {
  const auto give_up = SteadyClock::now() + kLongestBusy;
  milliseconds pause = kFirstPause;
  for (int unanswered = 0; unanswered < kAttempts;) {
    const std::uint16_t request = send(camera, command, gvcp::kAcknowledged, payload);
    auto ack = receive(command, request, SteadyClock::now() + kPatience);
    if (!ack) {
      ++unanswered;
      continue;
    }
    if (ack->status != gvcp::kBusy || SteadyClock::now() + pause > give_up) return ack;
    std::this_thread::sleep_for(pause);
    pause = std::min(2 * pause, kPatience);
  }
  return std::nullopt;
}

std::optional<std::uint32_t> GvcpSocket::read_register(std::uint32_t camera, std::uint32_t address) {
  std::vector<std::uint8_t> payload;
  gvcp::put32(payload, address);
  const auto ack = ask(camera, gvcp::kReadRegister, payload);
  if (!ack || ack->status != 0 || ack->payload.size() < 4) return std::nullopt;
  return gvcp::get32(ack->payload, 0);
}

void GvcpSocket::write_register(std::uint32_t camera, std::uint32_t address, std::uint32_t value) {
  std::vector<std::uint8_t> payload;
  gvcp::put32(payload, address);
  gvcp::put32(payload, value);
  const auto ack = ask(camera, gvcp::kWriteRegister, payload);
  if (ack && ack->status == 0) return;
  std::ostringstream what;
  what << "the camera at " << gvcp::address_text(camera);
  if (!ack) throw Error(ErrorCode::kCameraDisconnected, what.str() + " does not answer");
  what << " refuses register 0x" << std::hex << address << ": " << refusal(ack->status);
  throw Error(ErrorCode::kCameraSettings, what.str());
}

}  // namespace fvd
