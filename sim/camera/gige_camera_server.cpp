#include "sim/camera/gige_camera_server.hpp"

#include <array>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <stop_token>
#include <thread>
#include <vector>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include "core/base/error.hpp"
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

/// The control port, or an exception that says who else may have it.
int control_port(std::uint32_t address, const std::string& text) {
  const int fd = bind_control_port(address);
  if (fd >= 0) return fd;
  throw Error(ErrorCode::kBadConfig, "the simulated camera cannot have UDP " + std::to_string(gvcp::kPort) + " of " +
                                         text + ": " + std::strerror(errno) +
                                         "; choose another address of 127.0.0.0/8");
}

}  // namespace

struct GigeCameraServer::Impl {
  Impl(FrameSource& source, const GigeCameraOptions& o)
      : options(o),
        address(parse_address(o.address)),
        socket(control_port(address, o.address)),
        wake(::eventfd(0, EFD_CLOEXEC)),
        registers({.serial = o.serial,
                   .address = address,
                   .sensor_width = source.sensor_width(),
                   .sensor_height = source.sensor_height()}),
        sender(address, o.link_mbps, o.seed),
        streamer(source, registers, faults, mute, hung, sender, o.first_block_id, o.extended_ids,
                 [this](const CameraFaultStep& step) { strike(step); }),
        control(registers, streamer, sender, faults, [this](const CameraFaultStep& step) { strike(step); }) {
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
    if (step.fault == CameraFault::kHang) return hung.until(end);
    mute.until(end);
    if (step.fault != CameraFault::kRestart) return;
    restarting = true;
    wake_up();
  }

  void serve(std::stop_token stop) {
    std::array<std::uint8_t, 2048> buffer{};
    while (!stop.stop_requested()) {
      std::array<pollfd, 2> waiting{{{socket.get(), POLLIN, 0}, {wake.get(), POLLIN, 0}}};
      // Datagrams that come while it hangs wait in the socket, as those to a stopped process.
      if (hung.now()) waiting[0].events = 0;
      ::poll(waiting.data(), waiting.size(), hung.now() ? 1 : kPollInterval_ms);
      if ((waiting[1].revents & POLLIN) != 0) {
        std::uint64_t count = 0;
        [[maybe_unused]] const auto read = ::read(wake.get(), &count, sizeof(count));
      }
      if (restarting.exchange(false)) control.restart();
      if (hung.now()) continue;
      control.check_heartbeat();
      if ((waiting[0].revents & POLLIN) == 0) continue;
      sockaddr_in from{};
      socklen_t length = sizeof(from);
      const auto count = ::recvfrom(socket.get(), buffer.data(), buffer.size(), MSG_DONTWAIT,
                                    reinterpret_cast<sockaddr*>(&from), &length);
      if (count <= 0 || mute.now()) continue;
      const auto reply = control.answer({ntohl(from.sin_addr.s_addr), ntohs(from.sin_port)},
                                        std::span(buffer.data(), static_cast<std::size_t>(count)));
      if (reply.empty() || mute.now()) continue;
      ::sendto(socket.get(), reply.data(), reply.size(), MSG_NOSIGNAL, reinterpret_cast<const sockaddr*>(&from),
               length);
    }
  }

  const GigeCameraOptions options;
  const std::uint32_t address;
  const FileDescriptor socket;
  const FileDescriptor wake;
  CameraFaultScript faults;
  Standstill mute;
  Standstill hung;
  std::atomic<bool> restarting{false};
  CameraRegisters registers;
  GvspSender sender;
  GigeStreamer streamer;
  GigeControl control;  // serving thread only
  std::jthread serving;
};

GigeCameraServer::GigeCameraServer(FrameSource& source, const GigeCameraOptions& options)
    : impl_(std::make_unique<Impl>(source, options)) {}
GigeCameraServer::~GigeCameraServer() = default;

std::string GigeCameraServer::address() const { return impl_->options.address; }
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
    const in_addr network{htonl(address)};
    std::array<char, INET_ADDRSTRLEN> text{};
    return ::inet_ntop(AF_INET, &network, text.data(), text.size());
  }
  throw Error(ErrorCode::kBadConfig, "no loopback address with a free UDP port " + std::to_string(gvcp::kPort));
}

}  // namespace fvd::sim
