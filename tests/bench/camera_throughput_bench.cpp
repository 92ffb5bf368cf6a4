/// Frames per second through the driver, and what receiving them costs.

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include "drivers/aravis/aravis_camera.hpp"
#include "sim/camera/gige_camera_server.hpp"
#include "sim/camera/gvsp_sender.hpp"
#include "sim/world/pattern_source.hpp"
#include "tests/bench/camera_benches.hpp"

namespace fvd::test {

namespace {

using std::chrono::milliseconds;

double seconds_of(HostClock::duration time) { return std::chrono::duration<double>(time).count(); }

/// CPU time of the threads whose name begins so, in s.
double cpu_seconds(const std::string& name) {
  double ticks = 0.0;
  for (const auto& task : std::filesystem::directory_iterator("/proc/self/task")) {
    std::string comm;
    std::getline(std::ifstream(task.path() / "comm") >> std::ws, comm);
    if (comm.compare(0, name.size(), name) != 0) continue;
    std::string stat;
    std::getline(std::ifstream(task.path() / "stat"), stat);
    std::istringstream fields(stat.substr(stat.rfind(')') + 2));
    std::string skipped;
    for (int i = 0; i < 11; ++i) fields >> skipped;
    double user = 0.0;
    double system = 0.0;
    fields >> user >> system;
    ticks += user + system;
  }
  return ticks / static_cast<double>(::sysconf(_SC_CLK_TCK));
}

}  // namespace

double server_frames_per_s() {
  const std::string address = sim::free_camera_address();
  in_addr ip{};
  ::inet_pton(AF_INET, address.c_str(), &ip);
  sim::GvspSender sender(ntohl(ip.s_addr), 0.0, 1);
  const int sink = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  sockaddr_in own{};
  own.sin_family = AF_INET;
  own.sin_addr = ip;
  socklen_t length = sizeof own;
  ::bind(sink, reinterpret_cast<const sockaddr*>(&own), sizeof own);
  ::getsockname(sink, reinterpret_cast<sockaddr*>(&own), &length);
  const std::jthread reader([sink](std::stop_token stop) {
    std::vector<char> packet(10000);
    while (!stop.stop_requested()) {
      pollfd readable{sink, POLLIN, 0};
      if (::poll(&readable, 1, 20) > 0) (void)::recv(sink, packet.data(), packet.size(), MSG_DONTWAIT);
    }
  });
  sim::PatternSource pattern(2048, 2048);
  sim::ExposureRequest request;
  request.width = request.height = 2048;
  const HostTime begin = HostClock::now();
  int frames = 0;
  for (; seconds_of(HostClock::now() - begin) < 2.0; ++frames) {
    const auto frame = sender.spare();
    frame->block_id = static_cast<std::uint64_t>(frames + 1);
    frame->width = frame->height = 2048;
    frame->packet_size = 9000;
    frame->pixels.resize(2048UL * 2048UL);
    frame->to_address = ntohl(own.sin_addr.s_addr);
    frame->to_port = ntohs(own.sin_port);
    pattern.render(request, frame->pixels);
    sender.send(frame, {});
  }
  const double per_s = frames / seconds_of(HostClock::now() - begin);
  std::printf("the camera can send %.0f frames/s (%.0f MB/s)\n", per_s, per_s * 2048 * 2048 / 1e6);
  return per_s;
}

Throughput run_free(double link_mbps, double rate_hz, double duration_s, bool packet_socket) {
  sim::PatternSource pattern(2048, 2048);
  const std::string address = sim::free_camera_address();
  sim::GigeCameraServer server(pattern, {.address = address, .link_mbps = link_mbps});
  CameraConfig config;
  config.address = address;
  config.packet_socket = packet_socket;
  config.packet_size_bytes = 9000;
  auto camera = open_aravis_camera(config);
  CameraSettings settings;
  settings.exposure_us = 100.0;
  settings.trigger = TriggerMode::kFreeRun;
  settings.frame_rate_hz = rate_hz;
  settings.pool_frames = 32;
  camera->configure(settings);
  const auto count_until = [&](HostTime end) {
    std::uint64_t frames = 0;
    while (HostClock::now() < end) {
      const auto frame = camera->next_frame(HostClock::now() + milliseconds(100));
      if (frame && frame->status == FrameStatus::kOk) ++frames;
    }
    return frames;
  };
  (void)count_until(HostClock::now() + milliseconds(500));
  const CameraHealth before = camera->health();
  const std::uint64_t dropped = server.frames_dropped();
  const double cpu = cpu_seconds("arv_gv_stream");
  const HostTime begin = HostClock::now();
  const std::uint64_t frames =
      count_until(begin + std::chrono::duration_cast<HostClock::duration>(std::chrono::duration<double>(duration_s)));
  Throughput result;
  result.duration_s = seconds_of(HostClock::now() - begin);
  result.frames_per_s = static_cast<double>(frames) / result.duration_s;
  result.core_percent = 100.0 * (cpu_seconds("arv_gv_stream") - cpu) / result.duration_s;
  const CameraHealth after = camera->health();
  // What the simulated sensor dropped, because the simulation could not keep up, nobody lost on the way.
  const std::uint64_t gone = after.ids_skipped - before.ids_skipped + after.frames_failed - before.frames_failed;
  result.lost = gone - std::min(gone, server.frames_dropped() - dropped);
  std::printf(
      "free run at %.0f Mb/s, %.0f Hz asked: %.1f frames/s (%.0f MB/s), receiver %.1f %% of a core, %llu lost, "
      "%llu dropped at the sensor\n",
      link_mbps, rate_hz, result.frames_per_s, result.frames_per_s * 2048 * 2048 / 1e6, result.core_percent,
      static_cast<unsigned long long>(result.lost), static_cast<unsigned long long>(server.frames_dropped()));
  return result;
}

}  // namespace fvd::test
