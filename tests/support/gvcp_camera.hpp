#pragma once

/// A camera on the control protocol of GigE Vision alone: it is found by broadcast and takes another address. It
/// listens on every address of a network namespace, which is the test's own.

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <map>
#include <string>
#include <thread>
#include <vector>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include "core/base/mutex.hpp"
#include "core/runtime/guarded_thread.hpp"

namespace fvd::test {

/// Answers unicast commands only where they went to its address. context: thread-safe.
class GvcpCamera {
 public:
  /// neighbour: a second camera of the same network, which hears only what is sent to its address.
  explicit GvcpCamera(std::uint32_t address, std::uint32_t mask = 0xFFFFFF00U, bool neighbour = false)
      : mac_low_(neighbour ? 0xCCDDEE02U : 0xCCDDEE01U), address_(address), mask_(mask) {
    fd_ = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    const int on = 1;
    ::setsockopt(fd_, IPPROTO_IP, IP_PKTINFO, &on, sizeof on);
    ::setsockopt(fd_, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
    sockaddr_in here{};
    here.sin_family = AF_INET;
    here.sin_port = htons(3956);
    if (neighbour) here.sin_addr.s_addr = htonl(address);
    bound_ = ::bind(fd_, reinterpret_cast<const sockaddr*>(&here), sizeof here) == 0;
    thread_ = start_thread("gvcp-camera", [this](const std::stop_token& stop) { serve(stop); });
  }
  ~GvcpCamera() {
    thread_ = {};
    ::close(fd_);
  }
  GvcpCamera(const GvcpCamera&) = delete;
  GvcpCamera& operator=(const GvcpCamera&) = delete;

  [[nodiscard]] bool bound() const { return bound_; }
  [[nodiscard]] std::uint32_t address() const { return address_; }
  [[nodiscard]] std::uint32_t reg(std::uint32_t at) {
    const MutexLock lock(mutex_);
    return registers_[at];
  }
  void set_reg(std::uint32_t at, std::uint32_t value) {
    const MutexLock lock(mutex_);
    registers_[at] = value;
  }
  /// Keeps the address whatever FORCEIP says.
  void be_deaf_to_force_ip() { deaf_ = true; }
  /// Refuses every second write as busy; announces every other one by PENDING_ACK and acknowledges it `later`.
  void write_slowly(std::chrono::milliseconds later) { write_time_ms_ = static_cast<int>(later.count()); }
  /// Answers to discoveries lack their last byte, those to register reads their payload.
  void answer_too_short() { short_ = true; }

 private:
  using Bytes = std::vector<std::uint8_t>;

  static void put16(Bytes& out, std::uint32_t value) {
    out.push_back(static_cast<std::uint8_t>((value >> 8U) & 0xFFU));
    out.push_back(static_cast<std::uint8_t>(value & 0xFFU));
  }
  static void put32(Bytes& out, std::uint32_t value) {
    put16(out, value >> 16U);
    put16(out, value & 0xFFFFU);
  }
  static std::uint32_t get32(const std::uint8_t* bytes) {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes, 4);
    return ntohl(value);
  }
  static void put_text(Bytes& out, std::string text, std::size_t size) {
    text.resize(size, '\0');
    out.insert(out.end(), text.begin(), text.end());
  }

  Bytes bootstrap() const {
    Bytes out;
    put32(out, 0x00010002);
    put32(out, 0);
    put32(out, 0x0000AABB);  // MAC
    put32(out, mac_low_);
    put32(out, 7);
    put32(out, 6);
    out.resize(0x24, 0);
    put32(out, address_);
    out.resize(0x34, 0);
    put32(out, mask_);
    out.resize(0x48, 0);
    put_text(out, "Acme", 32);
    put_text(out, "One", 32);
    put_text(out, "1.2.3", 32);
    put_text(out, "", 48);
    put_text(out, "SN42", 16);
    put_text(out, "left", 16);
    return out;
  }

  void serve(const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      pollfd readable{fd_, POLLIN, 0};
      if (::poll(&readable, 1, 20) <= 0) continue;
      std::array<std::uint8_t, 600> in{};
      alignas(cmsghdr) std::array<char, 128> control{};
      sockaddr_in from{};
      iovec content{in.data(), in.size()};
      msghdr message{&from, sizeof from, &content, 1, control.data(), control.size(), 0};
      const ssize_t size = ::recvmsg(fd_, &message, 0);
      if (size < 8) continue;
      std::uint32_t to = 0;
      for (cmsghdr* at = CMSG_FIRSTHDR(&message); at != nullptr; at = CMSG_NXTHDR(&message, at)) {
        if (at->cmsg_level != IPPROTO_IP || at->cmsg_type != IP_PKTINFO) continue;
        in_pktinfo info{};
        std::memcpy(&info, CMSG_DATA(at), sizeof info);
        to = ntohl(info.ipi_addr.s_addr);
      }
      answer(in.data(), static_cast<std::size_t>(size), from, to);
    }
  }

  void answer(const std::uint8_t* in, std::size_t size, const sockaddr_in& from, std::uint32_t to) {
    const bool broadcast = to == 0xFFFFFFFFU;
    if (!broadcast && to != address_) return;
    const unsigned command = (in[2] << 8U) | in[3];
    Bytes payload;
    std::uint32_t status = 0;
    const MutexLock lock(mutex_);
    if (command == 0x0002) {
      payload = bootstrap();
      if (short_) payload.pop_back();
    } else if (command == 0x0004 && size >= 64 && get32(in + 12) == mac_low_ && !deaf_) {
      address_ = get32(in + 28);
      mask_ = get32(in + 44);
    } else if (command == 0x0080 && !broadcast && size >= 12) {
      if (!short_) put32(payload, registers_[get32(in + 8)]);
    } else if (command == 0x0082 && !broadcast && size >= 16) {
      const std::uint32_t at = get32(in + 8);
      if (at != 0x0A00 && registers_[0x0A00] == 0) status = 0x8006;
      if (write_time_ms_ > 0) status = ++writes_ % 2 == 0 ? status : 0x8007;
      if (status == 0 && write_time_ms_ > 0) {
        Bytes pending;
        put32(pending, 10U * static_cast<std::uint32_t>(write_time_ms_));
        send(in, from, 0, 0x0089, pending);
        std::this_thread::sleep_for(std::chrono::milliseconds(write_time_ms_));  // its memory takes so long
      }
      if (status == 0) registers_[at] = get32(in + 12);
      put32(payload, 1);
    } else {
      return;
    }
    send(in, from, status, command + 1, payload);
  }

  void send(const std::uint8_t* in, const sockaddr_in& from, std::uint32_t status, std::uint32_t command,
            const Bytes& payload) const {
    Bytes out;
    put16(out, status);
    put16(out, command);
    put16(out, static_cast<std::uint32_t>(payload.size()));
    out.push_back(in[6]);
    out.push_back(in[7]);
    out.insert(out.end(), payload.begin(), payload.end());
    ::sendto(fd_, out.data(), out.size(), 0, reinterpret_cast<const sockaddr*>(&from), sizeof from);
  }

  int fd_ = -1;
  bool bound_ = false;
  std::atomic<bool> deaf_{false};
  std::atomic<bool> short_{false};
  std::atomic<int> write_time_ms_{0};  // 0: at once
  int writes_ = 0;
  const std::uint32_t mac_low_;
  std::atomic<std::uint32_t> address_;
  std::atomic<std::uint32_t> mask_;
  Mutex mutex_;
  std::map<std::uint32_t, std::uint32_t> registers_ FVD_GUARDED_BY(mutex_);
  std::jthread thread_;  // last
};

}  // namespace fvd::test
