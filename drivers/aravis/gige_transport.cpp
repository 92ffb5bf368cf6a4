#include "drivers/aravis/gige_transport.hpp"

#include <algorithm>
#include <cstring>
#include <fstream>
#include <memory>
#include <mutex>

#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>
#include <spdlog/spdlog.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include "core/base/error.hpp"
#include "drivers/aravis/gobject.hpp"

namespace fvd {

namespace {

constexpr int kUsualMtu = 1500;
/// Beyond it the kernel's limit, net.core.rmem_max, cuts it down without a word.
constexpr int kReceiveBuffer_bytes = 32 << 20;
/// Less than this does not hold what arrives while the receiving thread is not scheduled.
constexpr long kLeastReceiveBuffer_bytes = 4 << 20;

/// Name of the interface that has the address.
std::string interface_of(const in_addr& address) {
  ifaddrs* list = nullptr;
  if (::getifaddrs(&list) != 0) return {};
  const std::unique_ptr<ifaddrs, decltype(&::freeifaddrs)> owner(list, &::freeifaddrs);
  std::string within;
  for (const ifaddrs* each = list; each != nullptr; each = each->ifa_next) {
    if (each->ifa_addr == nullptr || each->ifa_addr->sa_family != AF_INET) continue;
    const in_addr own = reinterpret_cast<const sockaddr_in*>(each->ifa_addr)->sin_addr;
    if (own.s_addr == address.s_addr) return each->ifa_name;
    // All of 127.0.0.0/8 belongs to an interface that has one of its addresses.
    const in_addr mask = reinterpret_cast<const sockaddr_in*>(each->ifa_netmask)->sin_addr;
    if ((each->ifa_flags & IFF_LOOPBACK) != 0 && ((own.s_addr ^ address.s_addr) & mask.s_addr) == 0) {
      within = each->ifa_name;
    }
  }
  return within;
}

int mtu_of(const std::string& interface) {
  const int fd = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (fd < 0) return 0;
  ifreq request{};
  std::strncpy(request.ifr_name, interface.c_str(), sizeof request.ifr_name - 1);
  const int result = ::ioctl(fd, SIOCGIFMTU, &request);
  ::close(fd);
  return result == 0 ? request.ifr_mtu : 0;
}

/// The size that passes the test, or nothing if the camera sends no test packets.
std::optional<int> negotiated_size(ArvCamera* camera) {
  GErrorSlot error;
  const guint size = arv_camera_gv_auto_packet_size(camera, error.out());
  if (error.failed() || size == 0) return std::nullopt;
  return static_cast<int>(size);
}

}  // namespace

int interface_mtu(ArvGvDevice* device) {
  GSocketAddress* local = arv_gv_device_get_interface_address(device);
  if (local != nullptr && G_IS_INET_SOCKET_ADDRESS(local)) {
    GInetAddress* address = g_inet_socket_address_get_address(G_INET_SOCKET_ADDRESS(local));
    if (g_inet_address_get_family(address) == G_SOCKET_FAMILY_IPV4) {
      in_addr raw{};
      std::memcpy(&raw, g_inet_address_to_bytes(address), sizeof raw);
      const std::string name = interface_of(raw);
      const int mtu = name.empty() ? 0 : mtu_of(name);
      if (mtu > 0) return mtu;
    }
  }
  spdlog::warn("the MTU of the camera's network interface is unknown; packets stay at {} bytes", kUsualMtu);
  return kUsualMtu;
}

int set_packet_size(ArvCamera* camera, const CameraFeatures& features, const CameraConfig& config) {
  arv_camera_gv_set_packet_size_adjustment(camera, ARV_GV_PACKET_SIZE_ADJUSTMENT_NEVER);
  arv_camera_gv_set_stream_options(
      camera, config.packet_socket ? ARV_GV_STREAM_OPTION_NONE : ARV_GV_STREAM_OPTION_PACKET_SOCKET_DISABLED);
  const int mtu = interface_mtu(ARV_GV_DEVICE(arv_camera_get_device(camera)));
  const int largest = std::min(mtu, kLargestPacket_bytes);
  int size = config.packet_size_bytes;
  if (size == 0) size = negotiated_size(camera).value_or(kUsualMtu);
  if (size > largest) {
    // Fragments come through a quiet network and get lost in a busy one.
    if (config.packet_size_bytes != 0)
      spdlog::warn("packets of {} bytes do not fit the interface's MTU of {}", size, mtu);
    size = largest;
  }
  constexpr const char* kPacketSize = "GevSCPSPacketSize";
  if (features.available(kPacketSize)) {
    GErrorSlot error;
    gint64 min = 0;
    gint64 max = 0;
    arv_camera_get_integer_bounds(camera, kPacketSize, &min, &max, error.out());
    if (!error.failed() && max >= min) {
      const gint64 step = features.increment(kPacketSize);
      const gint64 fitting = std::clamp<gint64>(size, min, max);
      size = static_cast<int>(min + (fitting - min) / step * step);
    }
  }
  GErrorSlot error;
  arv_camera_gv_set_packet_size(camera, size, error.out());
  error.check("the camera at " + config.address + " refuses packets of " + std::to_string(size) + " bytes");
  const guint got = arv_camera_gv_get_packet_size(camera, error.out());
  error.check("the camera at " + config.address + " does not tell its packet size");
  if (config.packet_delay_ns > 0) {
    arv_camera_gv_set_packet_delay(camera, config.packet_delay_ns, error.out());
    error.check("the camera at " + config.address + " refuses a packet delay of " +
                std::to_string(config.packet_delay_ns) + " ns");
  }
  spdlog::info("camera packets: {} bytes, interface MTU {}", got, mtu);
  return static_cast<int>(got);
}

void set_stream_options(ArvStream* stream, const StreamTimes& times) {
  if (!ARV_IS_GV_STREAM(stream)) return;
  using std::chrono::microseconds;
  const microseconds packet_timeout =
      times.exposure + std::clamp(times.readout / 2, microseconds(5000), microseconds(20000));
  g_object_set(stream, "socket-buffer", ARV_GV_STREAM_SOCKET_BUFFER_FIXED, "socket-buffer-size", kReceiveBuffer_bytes,
               "packet-timeout", static_cast<guint>(packet_timeout.count()), "frame-retention",
               static_cast<guint>(times.deadline.count()), nullptr);
}

void warn_of_system_limits(bool packet_socket) {
  static std::once_flag once;
  std::call_once(once, [packet_socket] {
    if (packet_socket) {
      const int fd = ::socket(AF_PACKET, SOCK_RAW | SOCK_CLOEXEC, 0);
      if (fd >= 0) {
        ::close(fd);
        return;  // the packet socket's ring does not count against rmem_max
      }
      spdlog::warn("no packet socket: the process lacks CAP_NET_RAW; at full rate frames may get lost");
    }
    std::ifstream in("/proc/sys/net/core/rmem_max");
    long limit = 0;
    if (in >> limit && limit < kLeastReceiveBuffer_bytes) {
      spdlog::warn("net.core.rmem_max is {} bytes, a camera at full rate needs {}; see systemd/README.md", limit,
                   kReceiveBuffer_bytes);
    }
  });
}

}  // namespace fvd
