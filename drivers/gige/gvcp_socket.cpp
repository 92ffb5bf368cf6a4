#include "drivers/gige/gvcp_socket.hpp"

#include <array>
#include <cerrno>
#include <cstring>
#include <sstream>

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

constexpr std::uint16_t kPort = 3956;
constexpr std::size_t kHeaderBytes = 8;
constexpr std::uint8_t kKey = 0x42;
constexpr std::uint8_t kAcknowledge = 0x01;
constexpr int kAttempts = 3;
constexpr std::chrono::milliseconds kPatience{200};

std::uint8_t upper(std::uint16_t value) { return static_cast<std::uint8_t>(value >> 8U); }
std::uint8_t lower(std::uint16_t value) { return static_cast<std::uint8_t>(value & 0xFFU); }

std::string refusal(std::uint16_t status) {
  std::ostringstream text;
  text << "status 0x" << std::hex << status;
  if (status == 0x8006) text << ", access denied: another program controls it";
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
  const auto size = static_cast<std::uint16_t>(payload.size());
  std::vector<std::uint8_t> datagram{kKey,        flags,       upper(command),       lower(command),
                                     upper(size), lower(size), upper(last_request_), lower(last_request_)};
  datagram.insert(datagram.end(), payload.begin(), payload.end());
  if (!send_datagram(to, datagram)) {
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

std::optional<GvcpSocket::Acknowledge> GvcpSocket::receive(std::uint16_t command, std::uint16_t request,
                                                           SteadyClock::time_point until) {
  for (;;) {
    std::array<std::uint8_t, 1024> bytes{};
    sockaddr_in from{};
    socklen_t length = sizeof from;
    const ssize_t size = ::recvfrom(fd_, bytes.data(), bytes.size(), 0, reinterpret_cast<sockaddr*>(&from), &length);
    if (size >= static_cast<ssize_t>(kHeaderBytes)) {
      const auto told = static_cast<std::uint16_t>((bytes[2] << 8U) | bytes[3]);
      const auto id = static_cast<std::uint16_t>((bytes[6] << 8U) | bytes[7]);
      if (told != command + 1 || (request != 0 && id != request)) continue;
      return Acknowledge{ntohl(from.sin_addr.s_addr),
                         static_cast<std::uint16_t>((bytes[0] << 8U) | bytes[1]),
                         {bytes.begin() + kHeaderBytes, bytes.begin() + size}};
    }
    if (size >= 0) continue;
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(until - SteadyClock::now());
    if (left.count() <= 0) return std::nullopt;
    pollfd readable{fd_, POLLIN, 0};
    ::poll(&readable, 1, static_cast<int>(left.count()));
  }
}

std::optional<std::uint32_t> GvcpSocket::read_register(std::uint32_t camera, std::uint32_t address) {
  std::vector<std::uint8_t> payload;
  gvcp::put32(payload, address);
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    const std::uint16_t request = send(camera, gvcp::kReadRegister, kAcknowledge, payload);
    const auto ack = receive(gvcp::kReadRegister, request, SteadyClock::now() + kPatience);
    if (!ack) continue;
    if (ack->status != 0 || ack->payload.size() < 4) return std::nullopt;
    return gvcp::get32(ack->payload, 0);
  }
  return std::nullopt;
}

void GvcpSocket::write_register(std::uint32_t camera, std::uint32_t address, std::uint32_t value) {
  std::ostringstream what;
  what << "the camera at " << gvcp::address_text(camera);
  std::vector<std::uint8_t> payload;
  gvcp::put32(payload, address);
  gvcp::put32(payload, value);
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    const std::uint16_t request = send(camera, gvcp::kWriteRegister, kAcknowledge, payload);
    const auto ack = receive(gvcp::kWriteRegister, request, SteadyClock::now() + kPatience);
    if (!ack) continue;
    if (ack->status == 0) return;
    what << " refuses register 0x" << std::hex << address << ": " << refusal(ack->status);
    throw Error(ErrorCode::kCameraSettings, what.str());
  }
  what << " does not answer";
  throw Error(ErrorCode::kCameraDisconnected, what.str());
}

}  // namespace fvd
