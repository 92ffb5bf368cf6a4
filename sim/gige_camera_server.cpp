#include "sim/gige_camera_server.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <condition_variable>
#include <cstring>
#include <mutex>
#include <optional>
#include <stop_token>
#include <thread>
#include <vector>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include "core/error.hpp"
#include "sim/camera_registers.hpp"
#include "sim/gvcp.hpp"
#include "sim/gvsp_sender.hpp"

namespace fvd::sim {

namespace {

using gvcp::Command;
using gvcp::Status;
namespace reg = gvcp::reg;

using Bytes = std::vector<std::uint8_t>;

std::uint32_t parse_address(const std::string& text) {
  in_addr address{};
  if (::inet_pton(AF_INET, text.c_str(), &address) != 1) {
    throw Error(ErrorCode::kBadConfig, "the camera address '" + text + "' is no IPv4 address");
  }
  return ntohl(address.s_addr);
}

/// A UDP socket on the control port of the address, or -1 with errno.
int bind_control_port(std::uint32_t address) {
  const int fd = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  sockaddr_in own{};
  own.sin_family = AF_INET;
  own.sin_addr.s_addr = htonl(address);
  own.sin_port = htons(gvcp::kPort);
  if (::bind(fd, reinterpret_cast<const sockaddr*>(&own), sizeof(own)) == 0) return fd;
  const int error = errno;
  ::close(fd);
  errno = error;
  return -1;
}

struct Peer {
  std::uint32_t address = 0;
  std::uint16_t port = 0;
  bool operator==(const Peer&) const = default;
};

/// Takes one from a counter of faults; false when none is left.
bool take(std::atomic<int>& counter) {
  int left = counter.load();
  while (left > 0) {
    if (counter.compare_exchange_weak(left, left - 1)) return true;
  }
  return false;
}

}  // namespace

struct GigeCameraServer::Impl {
  Impl(FrameSource& frame_source, const GigeCameraOptions& o)
      : source(frame_source),
        options(o),
        address(parse_address(o.address)),
        control_socket(bind_control_port(address)),
        wake(::eventfd(0, EFD_CLOEXEC)),
        registers({.serial = o.serial,
                   .address = address,
                   .sensor_width = frame_source.sensor_width(),
                   .sensor_height = frame_source.sensor_height()}),
        sender(address, o.link_mbps, o.seed) {
    if (control_socket < 0) {
      const std::string reason = std::strerror(errno);
      ::close(wake);
      throw Error(ErrorCode::kBadConfig, "the simulated camera cannot have UDP " + std::to_string(gvcp::kPort) +
                                             " of " + o.address + ": " + reason +
                                             "; choose another address of 127.0.0.0/8");
    }
    registers.set(reg::kStreamSourcePort, static_cast<std::uint32_t>(sender.source_port()));
    streaming = std::jthread([this](std::stop_token stop) { stream(stop); });
    control = std::jthread([this](std::stop_token stop) { serve(stop); });
  }

  ~Impl() {
    control.request_stop();
    streaming.request_stop();
    const std::uint64_t one = 1;
    [[maybe_unused]] const auto written = ::write(wake, &one, sizeof(one));
    control = {};
    streaming = {};
    if (control_socket >= 0) ::close(control_socket);
    ::close(wake);
  }

  // --- control ---

  void serve(std::stop_token stop) {
    std::array<std::uint8_t, 2048> buffer{};
    while (!stop.stop_requested()) {
      std::array<pollfd, 2> waiting{{{control_socket, POLLIN, 0}, {wake, POLLIN, 0}}};
      ::poll(waiting.data(), waiting.size(), 100);
      check_heartbeat();
      if ((waiting[0].revents & POLLIN) == 0) continue;
      sockaddr_in from{};
      socklen_t length = sizeof(from);
      const auto count = ::recvfrom(control_socket, buffer.data(), buffer.size(), MSG_DONTWAIT,
                                    reinterpret_cast<sockaddr*>(&from), &length);
      if (count <= 0 || mute) continue;
      const Bytes reply = answer({ntohl(from.sin_addr.s_addr), ntohs(from.sin_port)},
                                 std::span(buffer.data(), static_cast<std::size_t>(count)));
      if (!reply.empty()) {
        ::sendto(control_socket, reply.data(), reply.size(), MSG_NOSIGNAL, reinterpret_cast<const sockaddr*>(&from),
                 length);
      }
    }
  }

  void check_heartbeat() {
    if (!controller) return;
    const auto timeout = std::chrono::milliseconds(registers.get(reg::kHeartbeatTimeout));
    if (HostClock::now() - last_heard > timeout) release_control();
  }

  void release_control() {
    controller.reset();
    registers.set(reg::kControlPrivilege, 0);
    registers.set(reg::kStreamPort, 0);
    registers.set(feature::kParametersLocked, 0);
    set_acquiring(false);
  }

  static Bytes acknowledgement(Status status, std::uint16_t command, std::uint16_t request, const Bytes& payload) {
    Bytes reply;
    gvcp::put16(reply, static_cast<unsigned>(status));
    gvcp::put16(reply, command + 1U);
    gvcp::put16(reply, static_cast<unsigned>(payload.size()));
    gvcp::put16(reply, request);
    reply.insert(reply.end(), payload.begin(), payload.end());
    return reply;
  }

  /// The reply to one datagram; empty = none. Nonsense gets no answer, as the standard wants.
  Bytes answer(Peer peer, std::span<const std::uint8_t> packet) {
    if (packet.size() < gvcp::kHeaderBytes || packet[0] != 0x42) return {};
    const std::uint16_t code = gvcp::get16(packet, 2);
    const std::uint16_t length = gvcp::get16(packet, 4);
    const std::uint16_t request = gvcp::get16(packet, 6);
    if (length != packet.size() - gvcp::kHeaderBytes) return {};
    const auto payload = packet.subspan(gvcp::kHeaderBytes);
    if (controller == peer) last_heard = HostClock::now();
    // A client that missed an acknowledgement repeats its request under the same number: not to be executed again.
    if (last_peer == peer && last_request == request && last_code == code) return last_reply;
    const Bytes reply = execute(peer, code, request, payload);
    last_peer = peer;
    last_request = request;
    last_code = code;
    last_reply = reply;
    return (packet[1] & 1U) != 0 ? reply : Bytes{};
  }

  Bytes execute(Peer peer, std::uint16_t code, std::uint16_t request, std::span<const std::uint8_t> payload) {
    Bytes data;
    Status status = Status::kNotImplemented;
    switch (static_cast<Command>(code)) {
      case Command::kDiscovery:
        data.resize(reg::kDiscoveryBytes);
        status = registers.read(0, data);
        break;
      case Command::kPacketResend:
        resend(payload);
        return {};
      case Command::kReadRegister:
        status = read_registers(payload, data);
        break;
      case Command::kReadMemory:
        status = read_memory(payload, data);
        break;
      case Command::kWriteRegister:
        status = write_registers(peer, payload, data);
        break;
      case Command::kWriteMemory:
        status = write_memory(peer, payload, data);
        break;
    }
    if (status != Status::kSuccess) data.clear();
    return acknowledgement(status, code, request, data);
  }

  void resend(std::span<const std::uint8_t> payload) {
    if (payload.size() < 12) return;
    const std::uint32_t first = gvcp::get32(payload, 4) & 0xFFFFFFU;
    const std::uint32_t last = gvcp::get32(payload, 8) & 0xFFFFFFU;
    sender.resend(gvcp::get16(payload, 2), first, last);
  }

  Status read_registers(std::span<const std::uint8_t> payload, Bytes& data) {
    if (payload.empty() || payload.size() % 4 != 0 || payload.size() > gvcp::kMaxPayload)
      return Status::kInvalidParameter;
    for (std::size_t at = 0; at < payload.size(); at += 4) {
      std::array<std::uint8_t, 4> value{};
      const Status status = registers.read(gvcp::get32(payload, at), value);
      if (status != Status::kSuccess) return status;
      data.insert(data.end(), value.begin(), value.end());
    }
    return Status::kSuccess;
  }

  Status read_memory(std::span<const std::uint8_t> payload, Bytes& data) {
    if (payload.size() != 8) return Status::kInvalidParameter;
    const std::uint32_t from = gvcp::get32(payload, 0);
    const std::uint16_t count = gvcp::get16(payload, 6);
    if (count == 0 || count > 536) return Status::kInvalidParameter;
    if (from % 4 != 0 || count % 4 != 0) return Status::kBadAlignment;
    data.resize(4U + count);
    std::copy_n(payload.begin(), 4, data.begin());
    return registers.read(from, std::span(data).subspan(4));
  }

  Status write_registers(Peer peer, std::span<const std::uint8_t> payload, Bytes& data) {
    if (payload.empty() || payload.size() % 8 != 0 || payload.size() > gvcp::kMaxPayload)
      return Status::kInvalidParameter;
    Status status = Status::kSuccess;
    unsigned written = 0;
    for (std::size_t at = 0; at < payload.size() && status == Status::kSuccess; at += 8) {
      status = write(peer, gvcp::get32(payload, at), payload.subspan(at + 4, 4));
      if (status == Status::kSuccess) ++written;
    }
    gvcp::put16(data, 0);
    gvcp::put16(data, written);
    return status;
  }

  Status write_memory(Peer peer, std::span<const std::uint8_t> payload, Bytes& data) {
    if (payload.size() < 8 || payload.size() % 4 != 0 || payload.size() > gvcp::kMaxPayload)
      return Status::kInvalidParameter;
    gvcp::put16(data, 0);
    gvcp::put16(data, static_cast<unsigned>(payload.size() - 4));
    return write(peer, gvcp::get32(payload, 0), payload.subspan(4));
  }

  Status write(Peer peer, std::uint32_t at, std::span<const std::uint8_t> bytes) {
    if (at == reg::kControlPrivilege && bytes.size() == 4) return write_privilege(peer, gvcp::get32(bytes, 0));
    if (controller != peer) return Status::kAccessDenied;
    const Status status = registers.write(at, bytes);
    if (status == Status::kSuccess && bytes.size() == 4) act_on(at, gvcp::get32(bytes, 0));
    return status;
  }

  Status write_privilege(Peer peer, std::uint32_t value) {
    if (controller && controller != peer) return Status::kAccessDenied;
    if (value == 0) {
      release_control();
      return Status::kSuccess;
    }
    controller = peer;
    last_heard = HostClock::now();
    registers.set(reg::kControlPrivilege, value);
    return Status::kSuccess;
  }

  void act_on(std::uint32_t at, std::uint32_t value) {
    switch (at) {
      case feature::kAcquisitionStart:
        return set_acquiring(true);
      case feature::kAcquisitionStop:
        return set_acquiring(false);
      case feature::kTriggerSoftware:
        return trigger();
      case reg::kTimestampControl: {
        const auto now = timestamp_ns(HostClock::now());
        registers.set(reg::kTimestampHigh, static_cast<std::uint32_t>(now >> 32U));
        registers.set(reg::kTimestampLow, static_cast<std::uint32_t>(now & 0xFFFFFFFFU));
        return;
      }
      case reg::kStreamPacketSize: {
        if ((value & gvcp::kFireTestPacket) == 0) return;
        const CameraState state = registers.state();
        return sender.send_test_packet(state.stream_address, state.stream_port, state.packet_size);
      }
      default:
        return;
    }
  }

  [[nodiscard]] std::uint64_t timestamp_ns(HostTime time) const {
    return static_cast<std::uint64_t>(std::chrono::duration_cast<std::chrono::nanoseconds>(time - started).count());
  }

  // --- streaming ---

  void set_acquiring(bool on) {
    {
      const std::lock_guard lock(mutex);
      if (on && !acquiring) next_block_id = options.first_block_id;
      acquiring = on;
      triggered = false;
    }
    changed.notify_all();
  }

  void trigger() {
    if (take(ignored_triggers)) return;
    {
      const std::lock_guard lock(mutex);
      if (!acquiring || exposing) return;
      triggered = true;
    }
    changed.notify_all();
  }

  void stream(std::stop_token stop) {
    HostTime next_free_run = HostClock::now();
    while (!stop.stop_requested()) {
      {
        std::unique_lock lock(mutex);
        const auto due = [&] { return acquiring && (triggered || !registers.state().triggered); };
        if (!changed.wait(lock, stop, due)) return;
        if (!triggered && HostClock::now() < next_free_run) {
          changed.wait_until(lock, stop, next_free_run, [&] { return !acquiring; });
          continue;
        }
        triggered = false;
        exposing = true;
      }
      const CameraState state = registers.state();
      next_free_run = HostClock::now() + std::chrono::duration_cast<HostClock::duration>(
                                             std::chrono::duration<double>(1.0 / state.frame_rate_hz));
      auto frame = expose(state, stop);
      {
        const std::lock_guard lock(mutex);
        exposing = false;
        if (!acquiring) continue;
        frame->block_id = next_block_id;
        next_block_id = static_cast<std::uint16_t>(next_block_id == 65535 ? 1 : next_block_id + 1);
      }
      if (!stop.stop_requested() && !mute && state.stream_port != 0) deliver(std::move(frame), stop);
    }
  }

  void wait(HostClock::duration time, std::stop_token stop) {
    std::unique_lock lock(mutex);
    changed.wait_for(lock, stop, time, [] { return false; });
  }

  std::shared_ptr<StreamFrame> expose(const CameraState& state, std::stop_token stop) {
    ExposureRequest request;
    request.format = state.format;
    request.offset_x = state.offset_x;
    request.offset_y = state.offset_y;
    request.width = state.width;
    request.height = take(cut) ? std::max(1, state.height / 2) : state.height;
    request.gain_db = state.gain_db;
    request.start = HostClock::now();
    wait(std::chrono::duration_cast<HostClock::duration>(std::chrono::duration<double, std::micro>(state.exposure_us)),
         stop);
    request.end = HostClock::now();
    request.exposure_index = exposures++;
    auto frame = std::make_shared<StreamFrame>();
    frame->timestamp_ns = timestamp_ns(request.start);
    frame->pfnc = state.pfnc;
    frame->width = static_cast<std::uint32_t>(request.width);
    frame->height = static_cast<std::uint32_t>(request.height);
    frame->offset_x = static_cast<std::uint32_t>(state.offset_x);
    frame->offset_y = static_cast<std::uint32_t>(state.offset_y);
    frame->to_address = state.stream_address;
    frame->to_port = state.stream_port;
    frame->packet_size = state.packet_size;
    frame->pixels.resize(static_cast<std::size_t>(request.width) * static_cast<std::size_t>(request.height) *
                         static_cast<std::size_t>(bytes_per_pixel(state.format)));
    source.render(request, frame->pixels);
    return frame;
  }

  void deliver(std::shared_ptr<const StreamFrame> frame, std::stop_token stop) {
    ++frames;
    if (take(dropped)) return;
    if (take(delayed)) wait(std::chrono::milliseconds(delay_ms), stop);
    sender.send(frame);
    if (take(repeated)) sender.send(frame);
  }

  FrameSource& source;
  const GigeCameraOptions options;
  const std::uint32_t address;
  const HostTime started = HostClock::now();
  int control_socket;
  int wake;
  CameraRegisters registers;
  GvspSender sender;

  // control thread only
  std::optional<Peer> controller;
  HostTime last_heard{};
  std::optional<Peer> last_peer;
  std::uint16_t last_request = 0;
  std::uint16_t last_code = 0;
  Bytes last_reply;

  std::mutex mutex;
  std::condition_variable_any changed;
  bool acquiring = false;  // these four: guarded by mutex
  bool triggered = false;
  bool exposing = false;
  std::uint16_t next_block_id = 1;
  std::uint64_t exposures = 0;  // streaming thread only

  std::atomic<std::uint64_t> frames{0};
  std::atomic<bool> mute{false};
  std::atomic<int> dropped{0};
  std::atomic<int> ignored_triggers{0};
  std::atomic<int> repeated{0};
  std::atomic<int> delayed{0};
  std::atomic<int> cut{0};
  std::atomic<std::int64_t> delay_ms{0};

  std::jthread streaming;  // the threads last
  std::jthread control;
};

GigeCameraServer::GigeCameraServer(FrameSource& source, const GigeCameraOptions& options)
    : impl_(std::make_unique<Impl>(source, options)) {}
GigeCameraServer::~GigeCameraServer() = default;

std::string GigeCameraServer::address() const { return impl_->options.address; }
std::uint64_t GigeCameraServer::frames() const noexcept { return impl_->frames; }
std::uint64_t GigeCameraServer::packets_lost() const noexcept { return impl_->sender.packets_lost(); }
std::uint64_t GigeCameraServer::packets_resent() const noexcept { return impl_->sender.packets_resent(); }
void GigeCameraServer::set_packet_loss(double ratio) { impl_->sender.set_packet_loss(ratio); }
void GigeCameraServer::set_mute(bool mute) { impl_->mute = mute; }
void GigeCameraServer::drop_frames(int count) { impl_->dropped = count; }
void GigeCameraServer::ignore_triggers(int count) { impl_->ignored_triggers = count; }
void GigeCameraServer::repeat_frames(int count) { impl_->repeated = count; }
void GigeCameraServer::delay_frames(int count, std::chrono::milliseconds delay) {
  impl_->delay_ms = delay.count();
  impl_->delayed = count;
}
void GigeCameraServer::cut_frames(int count) { impl_->cut = count; }

std::string free_camera_address() {
  const auto first = static_cast<std::uint32_t>(::getpid());
  for (std::uint32_t i = 0; i < 1000; ++i) {
    // 127.0.0.0/8 without the .0 and .255 ends
    const std::uint32_t number = (first * 7919U + i) % (254U * 250U);
    const std::uint32_t address = 0x7F010000U + ((number / 250U) << 8U) + number % 250U + 2U;
    const int fd = bind_control_port(address);
    if (fd < 0) continue;
    ::close(fd);
    const in_addr network{htonl(address)};
    std::array<char, INET_ADDRSTRLEN> text{};
    return ::inet_ntop(AF_INET, &network, text.data(), text.size());
  }
  throw Error(ErrorCode::kBadConfig, "no loopback address with a free UDP port " + std::to_string(gvcp::kPort));
}

}  // namespace fvd::sim
