#include "sim/camera/gvsp_sender.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <numeric>
#include <string>
#include <thread>
#include <vector>

#include <arpa/inet.h>
#include <fcntl.h>
#include <net/if.h>
#include <netinet/in.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include "core/base/error.hpp"

namespace fvd::sim {

namespace {

constexpr std::size_t kPacketsPerBatch = 32;
/// Pacing need not wake up more often than these take on a gigabit line.
constexpr std::size_t kBatchBytes = 48 * 1024;
constexpr std::ptrdiff_t kReordered = 8;
constexpr std::size_t kMostUnavailable = 256;

sockaddr_in to_sockaddr(std::uint32_t address, int port) {
  sockaddr_in result{};
  result.sin_family = AF_INET;
  result.sin_addr.s_addr = htonl(address);
  result.sin_port = htons(static_cast<std::uint16_t>(port));
  return result;
}

/// A socket on any free port of the address, or -1 with errno.
int stream_socket(std::uint32_t address) {
  const int fd = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  const sockaddr_in own = to_sockaddr(address, 0);
  if (::bind(fd, reinterpret_cast<const sockaddr*>(&own), sizeof(own)) == 0) return fd;
  const int error = errno;
  if (fd >= 0) ::close(fd);
  errno = error;
  return -1;
}

int port_of(int fd) {
  sockaddr_in own{};
  socklen_t length = sizeof(own);
  ::getsockname(fd, reinterpret_cast<sockaddr*>(&own), &length);
  return ntohs(own.sin_port);
}

/// The camera lives on loopback.
int loopback_mtu(int fd) {
  ifreq request{};
  std::strcpy(request.ifr_name, "lo");
  return ::ioctl(fd, SIOCGIFMTU, &request) == 0 ? request.ifr_mtu : 65536;
}

}  // namespace

GvspSender::GvspSender(std::uint32_t address, double link_mbps, std::uint64_t seed)
    : socket_(stream_socket(address)),
      mtu_(loopback_mtu(socket_)),
      bytes_per_second_(link_mbps * 125000.0),
      random_(seed) {
  if (socket_ < 0) {
    throw Error(ErrorCode::kBadConfig,
                "the simulated camera has no socket for its stream: " + std::string(std::strerror(errno)));
  }
  source_port_ = port_of(socket_);
}

bool GvspSender::move_to(std::uint32_t address) {
  const int fd = stream_socket(address);
  if (fd < 0) return false;
  ::dup3(fd, socket_, O_CLOEXEC);  // at once for the thread that is sending
  ::close(fd);
  source_port_ = port_of(socket_);
  return true;
}

GvspSender::~GvspSender() { ::close(socket_); }

bool GvspSender::lose_packet() {
  const double ratio = packet_loss_;
  if (ratio <= 0.0) return false;
  const MutexLock lock(mutex_);
  if (std::uniform_real_distribution<double>(0.0, 1.0)(random_) >= ratio) return false;
  ++packets_lost_;
  return true;
}

std::shared_ptr<StreamFrame> GvspSender::spare() {
  std::shared_ptr<const StreamFrame> frame;
  {
    const MutexLock lock(mutex_);
    frame = std::move(spare_);
  }
  // Nobody else refers to it: a frame leaves the store for good before it becomes the spare one.
  if (frame && frame.use_count() == 1) return std::const_pointer_cast<StreamFrame>(frame);
  return std::make_shared<StreamFrame>();
}

void GvspSender::forget() {
  const MutexLock lock(mutex_);
  kept_.clear();
}

void GvspSender::send(const std::shared_ptr<const StreamFrame>& frame, const Sending& what) {
  {
    const MutexLock lock(mutex_);
    kept_.push_back(frame);
    if (kept_.size() > kKeptFrames) {
      spare_ = std::move(kept_.front());
      kept_.pop_front();
    }
  }
  std::vector<std::uint32_t> packets(gvsp::trailer_id(*frame) + 1);
  std::iota(packets.begin(), packets.end(), 0U);
  if (what.reordered) {
    for (auto begin = packets.begin() + 1; begin != packets.end() - 1;) {
      const auto end = begin + std::min(kReordered, packets.end() - 1 - begin);
      std::reverse(begin, end);
      begin = end;
    }
  }
  if (what.without != 0) std::erase(packets, what.without);
  auto first = packets.begin();
  auto last = packets.end();
  if (!what.leader) ++first;
  if (!what.trailer) --last;
  transmit(*frame, std::span(first, last));
}

void GvspSender::send_leader(const StreamFrame& frame) { transmit(frame, std::array<std::uint32_t, 1>{0}); }

void GvspSender::resend(const ResendRequest& request) {
  if (request.first > request.last) return;
  std::shared_ptr<const StreamFrame> frame;
  {
    const MutexLock lock(mutex_);
    const auto found = std::find_if(kept_.rbegin(), kept_.rend(),
                                    [&](const auto& kept) { return kept->block_id == request.block_id; });
    if (found != kept_.rend()) frame = *found;
  }
  std::vector<std::uint32_t> kept;
  std::vector<std::uint32_t> gone;
  const std::uint32_t end = frame ? gvsp::trailer_id(*frame) + 1 : 0;
  for (std::uint32_t packet = request.first; packet <= request.last; ++packet) {
    if (packet < end && !frame->gone.contains(packet)) {
      kept.push_back(packet);
    } else if (gone.size() < kMostUnavailable) {
      gone.push_back(packet);
    } else if (packet >= end) {
      break;
    }
  }
  send_unavailable(request, gone);
  if (kept.empty()) return;
  packets_resent_ += kept.size();
  transmit(*frame, kept);
}

void GvspSender::send_unavailable(const ResendRequest& request, std::span<const std::uint32_t> packets) {
  if (request.to_port == 0) return;
  const sockaddr_in to = to_sockaddr(request.to_address, request.to_port);
  for (const std::uint32_t packet : packets) {
    const auto bytes = gvsp::unavailable(request.block_id, request.extended_ids, packet);
    ::sendto(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL, reinterpret_cast<const sockaddr*>(&to), sizeof(to));
  }
}

void GvspSender::transmit(const StreamFrame& frame, std::span<const std::uint32_t> packets) {
  sockaddr_in to = to_sockaddr(frame.to_address, frame.to_port);
  std::array<std::vector<std::uint8_t>, kPacketsPerBatch> heads;
  std::array<std::array<iovec, 2>, kPacketsPerBatch> parts{};
  std::array<mmsghdr, kPacketsPerBatch> messages{};
  const HostTime begin = HostClock::now();
  double due_s = 0.0;
  for (std::size_t next = 0; next < packets.size();) {
    unsigned count = 0;
    std::size_t batch_bytes = 0;
    for (; next < packets.size() && count < kPacketsPerBatch && batch_bytes < kBatchBytes; ++next) {
      const std::uint32_t packet = packets[next];
      const auto pixels = gvsp::body(frame, packet);
      batch_bytes += static_cast<std::size_t>(gvsp::header_bytes(frame.extended_ids)) + pixels.size();
      due_s += frame.delay_ns * 1e-9;
      if (frame.gone.contains(packet) || lose_packet()) continue;
      heads[count] = gvsp::head(frame, packet);
      parts[count][0] = {heads[count].data(), heads[count].size()};
      parts[count][1] = {const_cast<std::byte*>(pixels.data()), pixels.size()};
      messages[count] = {};
      messages[count].msg_hdr.msg_name = &to;
      messages[count].msg_hdr.msg_namelen = sizeof(to);
      messages[count].msg_hdr.msg_iov = parts[count].data();
      messages[count].msg_hdr.msg_iovlen = pixels.empty() ? 1 : 2;
      ++count;
    }
    // A receiver that is gone is no concern of a camera.
    for (unsigned sent = 0; sent < count;) {
      const int done = ::sendmmsg(socket_, messages.data() + sent, count - sent, MSG_NOSIGNAL);
      sent += static_cast<unsigned>(std::max(done, 1));  // a packet the network refuses is a packet lost
    }
    if (bytes_per_second_ > 0.0) due_s += static_cast<double>(batch_bytes) / bytes_per_second_;
    if (due_s <= 0.0) continue;
    std::this_thread::sleep_until(
        begin + std::chrono::duration_cast<HostClock::duration>(std::chrono::duration<double>(due_s)));
  }
}

void GvspSender::send_test_packet(std::uint32_t to_address, int to_port, int size) {
  if (size > mtu_) return;
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(std::max(0, size - (gvsp::header_bytes(false) - 8))));
  const sockaddr_in to = to_sockaddr(to_address, to_port);
  ::sendto(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL, reinterpret_cast<const sockaddr*>(&to), sizeof(to));
}

}  // namespace fvd::sim
