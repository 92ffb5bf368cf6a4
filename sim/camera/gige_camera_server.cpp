#include "sim/camera/gige_camera_server.hpp"

#include <array>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <stop_token>
#include <thread>
#include <vector>

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include "core/base/error.hpp"
#include "core/base/mutex.hpp"
#include "core/runtime/guarded_thread.hpp"
#include "sim/base/file_descriptor.hpp"
#include "sim/camera/camera_registers.hpp"
#include "sim/camera/gige_control.hpp"
#include "sim/camera/gige_streamer.hpp"
#include "sim/camera/gvcp.hpp"
#include "sim/camera/gvsp_sender.hpp"

namespace fvd::sim {

namespace {

constexpr int kPollInterval_ms = 100;

std::uint32_t parse_address(const std::string& text) {
  in_addr address{};
  if (::inet_pton(AF_INET, text.c_str(), &address) != 1) {
    throw Error(ErrorCode::kBadConfig, "the camera address '" + text + "' is no IPv4 address");
  }
  return ntohl(address.s_addr);
}

std::string text_of(std::uint32_t address) {
  const in_addr network{htonl(address)};
  std::array<char, INET_ADDRSTRLEN> text{};
  return ::inet_ntop(AF_INET, &network, text.data(), text.size());
}

/// A UDP socket on the control port of the address, or -1 with errno. for_all: an address of broadcasts, which other
/// cameras may have too; only those that stay on loopback are heard.
int bind_control_port(std::uint32_t address, bool for_all = false) {
  const int fd = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  const int on = 1;
  if (for_all && (::setsockopt(fd, SOL_SOCKET, SO_REUSEADDR, &on, sizeof(on)) != 0 ||
                  ::setsockopt(fd, SOL_SOCKET, SO_BINDTODEVICE, "lo", 2) != 0)) {
    const int error = errno;
    ::close(fd);
    errno = error;
    return -1;
  }
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

/// The control port, or an exception that says who else may have it.
int control_port(std::uint32_t address, const std::string& text) {
  const int fd = bind_control_port(address);
  if (fd >= 0) return fd;
  throw Error(ErrorCode::kBadConfig, "the simulated camera cannot have UDP " + std::to_string(gvcp::kPort) + " of " +
                                         text + ": " + std::strerror(errno) +
                                         "; choose another address of 127.0.0.0/8");
}

/// A socket for what is sent to all cameras, or none.
int broadcast_port(std::uint32_t address, bool wanted) {
  if (!wanted) return -1;
  const int fd = bind_control_port(address, true);
  if (fd >= 0) return fd;
  throw Error(ErrorCode::kBadConfig, "the simulated camera cannot hear broadcasts to " + text_of(address) + ": " +
                                         std::strerror(errno) + "; run it without being discoverable");
}

const GigeCameraOptions& checked(const GigeCameraOptions& options) {
  for (const std::string* name : {&options.serial, &options.name}) {
    if (name->size() >= gvcp::reg::kUserNameBytes) {
      throw Error(ErrorCode::kBadConfig,
                  "the camera's name or serial number '" + *name + "' is longer than 15 characters");
    }
  }
  if (options.width_increment < 1) throw Error(ErrorCode::kBadConfig, "the camera's width increment is not above 0");
  return options;
}

constexpr std::uint32_t kAllDevices = 0xFFFFFFFF;
constexpr std::uint32_t kAllOfLoopback = 0x7FFFFFFF;

}  // namespace

struct GigeCameraServer::Impl {
  Impl(FrameSource& source, const GigeCameraOptions& o)
      : options(checked(o)),
        address(parse_address(o.address)),
        socket(control_port(address, o.address)),
        to_all(broadcast_port(kAllDevices, o.discoverable)),
        to_loopback(broadcast_port(kAllOfLoopback, o.discoverable)),
        wake(::eventfd(0, EFD_CLOEXEC)),
        registers({.serial = o.serial,
                   .user_name = o.name,
                   .address = address,
                   .sensor_width = source.sensor_width(),
                   .sensor_height = source.sensor_height(),
                   .width_increment = o.width_increment,
                   .chunk_mode = o.chunk_mode,
                   .payload_margin_bytes = o.payload_margin_bytes,
                   .edit_description = o.edit_description}),
        sender(address, o.link_mbps, o.seed),
        streamer(source, registers, faults, mute, hung, sender, o.first_block_id, o.extended_ids,
                 [this](const CameraFaultStep& step) { strike(step); }),
        control(
            registers, streamer, sender, faults, [this](const CameraFaultStep& step) { strike(step); },
            [this](std::uint32_t to) { return move(to); }) {
    registers.set(gvcp::reg::kStreamSourcePort, static_cast<std::uint32_t>(sender.source_port()));
    serving = start_thread("sim-gvcp", [this](std::stop_token stop) { serve(stop); });
  }

  ~Impl() {
    serving.request_stop();
    wake_up();
    serving.join();
  }

  void wake_up() {
    const std::uint64_t one = 1;
    [[maybe_unused]] const auto written = ::write(wake.get(), &one, sizeof(one));
  }

  /// Of any thread of the camera.
  void strike(const CameraFaultStep& step) {
    const HostTime end = HostClock::now() + step.delay;
    if (step.fault == CameraFault::kClockStep) return streamer.step_clock(step.step);
    if (step.fault == CameraFault::kChunkMode) {
      const ChunkMode mode = step.value == 1 ? ChunkMode::kPlain : ChunkMode::kExtended;
      return registers.set(feature::kChunkModeActive, static_cast<std::uint32_t>(mode));
    }
    if (step.fault == CameraFault::kHang) return hung.until(end);
    mute.until(end);
    if (step.fault != CameraFault::kRestart) return;
    restarting = true;
    wake_up();
  }

  /// The camera's sockets keep their numbers.
  bool move(std::uint32_t to) {
    const int fd = bind_control_port(to);
    if (fd < 0) return false;
    const FileDescriptor moved(fd);
    if (!sender.move_to(to)) return false;
    ::dup3(fd, socket.get(), O_CLOEXEC);
    address = to;
    return true;
  }

  void serve(std::stop_token stop) {
    while (!stop.stop_requested()) {
      std::array<pollfd, 4> waiting{{{wake.get(), POLLIN, 0},
                                     {socket.get(), POLLIN, 0},
                                     {to_all.get(), POLLIN, 0},
                                     {to_loopback.get(), POLLIN, 0}}};
      // Datagrams that come while it hangs wait in the socket, as those to a stopped process.
      const bool hangs = hung.now();
      ::poll(waiting.data(), hangs ? 1 : waiting.size(), hangs || !held_back.empty() ? 1 : kPollInterval_ms);
      if ((waiting[0].revents & POLLIN) != 0) {
        std::uint64_t count = 0;
        [[maybe_unused]] const auto read = ::read(wake.get(), &count, sizeof(count));
      }
      if (restarting.exchange(false)) control.restart();
      if (hung.now()) continue;
      control.check_heartbeat();
      for (std::size_t i = 1; i < waiting.size(); ++i) {
        if ((waiting[i].revents & POLLIN) != 0) receive(waiting[i].fd);
      }
      send_what_is_due();
    }
  }

  void receive(int fd) {
    std::array<std::uint8_t, 2048> buffer{};
    sockaddr_in from{};
    socklen_t length = sizeof(from);
    const auto count =
        ::recvfrom(fd, buffer.data(), buffer.size(), MSG_DONTWAIT, reinterpret_cast<sockaddr*>(&from), &length);
    if (count <= 0 || mute.now()) return;
    const GvcpPeer peer{ntohl(from.sin_addr.s_addr), ntohs(from.sin_port)};
    const auto packet = std::span(buffer.data(), static_cast<std::size_t>(count));
    if (fd != socket.get()) return send(control.answer_broadcast(peer, packet), from);
    const auto reply = control.answer(peer, packet);
    send(reply.pending, from);
    if (reply.delay.count() == 0) return send(reply.acknowledge, from);
    held_back.push_back({HostClock::now() + reply.delay, reply.acknowledge, from});
  }

  void send(const std::vector<std::uint8_t>& message, const sockaddr_in& to) const {
    if (message.empty() || mute.now()) return;
    ::sendto(socket.get(), message.data(), message.size(), MSG_NOSIGNAL, reinterpret_cast<const sockaddr*>(&to),
             sizeof(to));
  }

  /// While a command takes long, others are answered.
  void send_what_is_due() {
    const HostTime now = HostClock::now();
    for (const HeldBack& one : held_back) {
      if (one.due <= now) send(one.acknowledge, one.to);
    }
    std::erase_if(held_back, [now](const HeldBack& one) { return one.due <= now; });
  }

  /// An acknowledge that was announced.
  struct HeldBack {
    HostTime due;
    std::vector<std::uint8_t> acknowledge;
    sockaddr_in to;
  };

  const GigeCameraOptions options;
  std::atomic<std::uint32_t> address;
  const FileDescriptor socket;
  const FileDescriptor to_all;  // broadcasts, if it is discoverable, as the next one
  const FileDescriptor to_loopback;
  const FileDescriptor wake;
  CameraFaultScript faults;
  Standstill mute;
  Standstill hung;
  std::atomic<bool> restarting{false};
  CameraRegisters registers;
  GvspSender sender;
  GigeStreamer streamer;
  GigeControl control;              // serving thread only
  std::vector<HeldBack> held_back;  // likewise
  std::jthread serving;
};

GigeCameraServer::GigeCameraServer(FrameSource& source, const GigeCameraOptions& options)
    : impl_(std::make_unique<Impl>(source, options)) {}
GigeCameraServer::~GigeCameraServer() = default;

std::string GigeCameraServer::address() const { return text_of(impl_->address); }
std::uint64_t GigeCameraServer::frames() const noexcept { return impl_->streamer.frames(); }
std::uint64_t GigeCameraServer::frames_dropped() const noexcept { return impl_->streamer.frames_dropped(); }
std::uint64_t GigeCameraServer::packets_lost() const noexcept { return impl_->sender.packets_lost(); }
std::uint64_t GigeCameraServer::packets_resent() const noexcept { return impl_->sender.packets_resent(); }
void GigeCameraServer::pulse_line() { (void)impl_->streamer.trigger(true); }
void GigeCameraServer::set_packet_loss(double ratio) { impl_->sender.set_packet_loss(ratio); }
CameraFaultScript& GigeCameraServer::faults() { return impl_->faults; }

std::string free_camera_address() {
  const auto first = static_cast<std::uint32_t>(::getpid());
  for (std::uint32_t i = 0; i < 1000; ++i) {
    // 127.0.0.0/8 without the .0 and .255 ends
    const std::uint32_t number = (first * 7919U + i) % (254U * 250U);
    const std::uint32_t address = 0x7F010000U + ((number / 250U) << 8U) + number % 250U + 2U;
    const int fd = bind_control_port(address);
    if (fd < 0) continue;
    ::close(fd);
    return text_of(address);
  }
  throw Error(ErrorCode::kBadConfig, "no loopback address with a free UDP port " + std::to_string(gvcp::kPort));
}

}  // namespace fvd::sim
