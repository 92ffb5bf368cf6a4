#include "sim/gvsp_sender.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <string>
#include <thread>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "core/error.hpp"
#include "sim/gvcp.hpp"

namespace fvd::sim {

namespace {

constexpr int kHeadersOnWire = 20 + 8 + 8;  // IP, UDP, GVSP
constexpr std::uint32_t kLeader = 1;
constexpr std::uint32_t kTrailer = 2;
constexpr std::uint32_t kPayload = 3;
constexpr unsigned kPayloadTypeImage = 1;
constexpr std::size_t kBatch = 16;

std::uint32_t payload_packets(const StreamFrame& frame) {
  const auto room = static_cast<std::size_t>(frame.packet_size - kHeadersOnWire);
  return static_cast<std::uint32_t>((frame.pixels.size() + room - 1) / room);
}

/// GVSP header and, for leader and trailer, their contents.
std::vector<std::uint8_t> head_of(const StreamFrame& frame, std::uint32_t packet, std::uint32_t trailer) {
  std::vector<std::uint8_t> bytes;
  gvcp::put16(bytes, 0);
  gvcp::put16(bytes, frame.block_id);
  const std::uint32_t type = packet == 0 ? kLeader : packet == trailer ? kTrailer : kPayload;
  gvcp::put32(bytes, (type << 24U) | packet);
  if (type == kLeader) {
    gvcp::put16(bytes, 0);
    gvcp::put16(bytes, kPayloadTypeImage);
    gvcp::put32(bytes, static_cast<std::uint32_t>(frame.timestamp_ns >> 32U));
    gvcp::put32(bytes, static_cast<std::uint32_t>(frame.timestamp_ns & 0xFFFFFFFFU));
    for (const auto value : {frame.pfnc, frame.width, frame.height, frame.offset_x, frame.offset_y, 0U}) {
      gvcp::put32(bytes, value);
    }
  } else if (type == kTrailer) {
    gvcp::put32(bytes, kPayloadTypeImage);
    gvcp::put32(bytes, frame.height);
  }
  return bytes;
}

sockaddr_in to_sockaddr(std::uint32_t address, int port) {
  sockaddr_in result{};
  result.sin_family = AF_INET;
  result.sin_addr.s_addr = htonl(address);
  result.sin_port = htons(static_cast<std::uint16_t>(port));
  return result;
}

}  // namespace

GvspSender::GvspSender(std::uint32_t address, double link_mbps, std::uint64_t seed)
    : socket_(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)), bytes_per_second_(link_mbps * 1e6 / 8), random_(seed) {
  sockaddr_in own = to_sockaddr(address, 0);
  socklen_t length = sizeof(own);
  if (socket_ < 0 || ::bind(socket_, reinterpret_cast<const sockaddr*>(&own), sizeof(own)) != 0 ||
      ::getsockname(socket_, reinterpret_cast<sockaddr*>(&own), &length) != 0) {
    const std::string reason = std::strerror(errno);
    if (socket_ >= 0) ::close(socket_);
    throw Error(ErrorCode::kBadConfig, "the simulated camera has no socket for its stream: " + reason);
  }
  source_port_ = ntohs(own.sin_port);
}

GvspSender::~GvspSender() { ::close(socket_); }

bool GvspSender::lose_packet() {
  const double ratio = packet_loss_;
  if (ratio <= 0.0) return false;
  const std::lock_guard lock(mutex_);
  if (std::uniform_real_distribution<double>(0.0, 1.0)(random_) >= ratio) return false;
  ++packets_lost_;
  return true;
}

void GvspSender::send(std::shared_ptr<const StreamFrame> frame) {
  {
    const std::lock_guard lock(mutex_);
    kept_.push_back(frame);
    if (kept_.size() > kKept) kept_.pop_front();
  }
  transmit(*frame, 0, payload_packets(*frame) + 1);
}

void GvspSender::resend(std::uint16_t block_id, std::uint32_t first, std::uint32_t last) {
  std::shared_ptr<const StreamFrame> frame;
  {
    const std::lock_guard lock(mutex_);
    const auto found =
        std::find_if(kept_.rbegin(), kept_.rend(), [&](const auto& kept) { return kept->block_id == block_id; });
    if (found == kept_.rend()) return;
    frame = *found;
  }
  const std::uint32_t trailer = payload_packets(*frame) + 1;
  if (first > last || first > trailer) return;
  packets_resent_ += std::min(last, trailer) - first + 1;
  transmit(*frame, first, std::min(last, trailer));
}

void GvspSender::transmit(const StreamFrame& frame, std::uint32_t first, std::uint32_t last) {
  const std::uint32_t trailer = payload_packets(frame) + 1;
  const auto room = static_cast<std::size_t>(frame.packet_size - kHeadersOnWire);
  sockaddr_in to = to_sockaddr(frame.to_address, frame.to_port);
  std::array<std::vector<std::uint8_t>, kBatch> heads;
  std::array<std::array<iovec, 2>, kBatch> parts{};
  std::array<mmsghdr, kBatch> messages{};
  const HostTime begin = HostClock::now();
  std::size_t bytes_sent = 0;
  for (std::uint32_t packet = first; packet <= last;) {
    unsigned count = 0;
    for (; packet <= last && count < kBatch; ++packet) {
      const std::size_t at = packet == 0 || packet == trailer ? 0 : (packet - 1) * room;
      const std::size_t size = packet == 0 || packet == trailer ? 0 : std::min(room, frame.pixels.size() - at);
      bytes_sent += static_cast<std::size_t>(kHeadersOnWire) + size;
      if (lose_packet()) continue;
      heads[count] = head_of(frame, packet, trailer);
      parts[count][0] = {heads[count].data(), heads[count].size()};
      parts[count][1] = {const_cast<std::byte*>(frame.pixels.data()) + at, size};
      messages[count] = {};
      messages[count].msg_hdr.msg_name = &to;
      messages[count].msg_hdr.msg_namelen = sizeof(to);
      messages[count].msg_hdr.msg_iov = parts[count].data();
      messages[count].msg_hdr.msg_iovlen = size > 0 ? 2 : 1;
      ++count;
    }
    // A receiver that is gone is no concern of a camera.
    if (count > 0) ::sendmmsg(socket_, messages.data(), count, MSG_NOSIGNAL);
    const auto due = std::chrono::duration<double>(static_cast<double>(bytes_sent) / bytes_per_second_);
    std::this_thread::sleep_until(begin + std::chrono::duration_cast<HostClock::duration>(due));
  }
}

void GvspSender::send_test_packet(std::uint32_t to_address, int to_port, int size) {
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(std::max(0, size - (kHeadersOnWire - 8))));
  const sockaddr_in to = to_sockaddr(to_address, to_port);
  ::sendto(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL, reinterpret_cast<const sockaddr*>(&to), sizeof(to));
}

}  // namespace fvd::sim
