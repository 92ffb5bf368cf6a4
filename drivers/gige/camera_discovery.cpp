#include "drivers/gige/camera_discovery.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <list>
#include <optional>
#include <span>
#include <tuple>

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>

#include "core/base/error.hpp"
#include "drivers/gige/gvcp_socket.hpp"

namespace fvd {

namespace {

using SteadyClock = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr std::uint32_t kEverybody = 0xFFFFFFFFU;
/// Length of the answer: the bootstrap registers from 0x0000 on.
constexpr std::size_t kAnswerBytes = 0xF8;
/// A camera answers at once; a question that got lost is repeated.
constexpr milliseconds kRepeat{50};
constexpr milliseconds kRepeatSearch{200};
constexpr std::uint16_t kAnyRequest = 0;
/// Most answers that one wait reads: a flood does not hold it.
constexpr int kMostAnswers = 1000;
/// Each interface is listened to for so long in its turn.
constexpr milliseconds kTurn{5};
constexpr milliseconds kForOthers{100};
constexpr std::uint32_t kAnyControl = 0x3;  // exclusive, or with others reading

std::uint32_t host_order(const sockaddr* address) {
  return address == nullptr ? 0 : ntohl(reinterpret_cast<const sockaddr_in*>(address)->sin_addr.s_addr);
}

std::string text_at(std::span<const std::uint8_t> bytes, std::size_t at, std::size_t size) {
  const auto field = bytes.subspan(at, size);
  std::string text;
  for (const std::uint8_t byte : field) {
    if (byte == 0) break;
    text += byte < 0x20 || byte == 0x7F ? ' ' : static_cast<char>(byte);
  }
  return text;
}

std::string mac_text(std::span<const std::uint8_t> bytes) {
  std::array<char, 18> text{};
  std::snprintf(text.data(), text.size(), "%02x:%02x:%02x:%02x:%02x:%02x", bytes[10], bytes[11], bytes[12], bytes[13],
                bytes[14], bytes[15]);
  return text.data();
}

void ask_control(GvcpSocket& socket, FoundCamera& camera) {
  const auto address = gvcp::address_of(camera.address);
  const auto privilege = address ? socket.read_register(*address, gvcp::kControlPrivilege) : std::nullopt;
  if (!privilege) return;
  camera.control = (*privilege & kAnyControl) != 0 ? CameraControl::kControlled : CameraControl::kFree;
  if (camera.control != CameraControl::kControlled) return;
  const auto controller = socket.read_register(*address, gvcp::kControllerAddress);
  const auto port = socket.read_register(*address, gvcp::kControllerPort);
  if (!controller || *controller == 0 || !port) return;
  camera.controller = gvcp::address_text(*controller) + ":" + std::to_string(*port & 0xFFFFU);
}

/// Both must see each other as neighbours, or there is no way back for the pictures.
bool fits(const NetworkInterface& interface, const FoundCamera& camera) {
  const auto address = gvcp::address_of(camera.address);
  const auto mask = gvcp::address_of(camera.mask);
  if (!address || !mask) return false;
  return (*address & interface.mask) == (interface.address & interface.mask) &&
         (*address & *mask) == (interface.address & *mask);
}

/// Lists the interfaces that are up.
template <typename Wanted>
std::vector<NetworkInterface> interfaces_that(Wanted&& wanted) {
  ifaddrs* first = nullptr;
  std::vector<NetworkInterface> interfaces;
  if (::getifaddrs(&first) != 0) return interfaces;
  for (const ifaddrs* at = first; at != nullptr; at = at->ifa_next) {
    if (at->ifa_addr == nullptr || at->ifa_addr->sa_family != AF_INET || (at->ifa_flags & IFF_UP) == 0) continue;
    const NetworkInterface interface {
      at->ifa_name, static_cast<int>(::if_nametoindex(at->ifa_name)), host_order(at->ifa_addr),
          host_order(at->ifa_netmask)
    };
    if (wanted(interface, (at->ifa_flags & IFF_LOOPBACK) != 0)) interfaces.push_back(interface);
  }
  ::freeifaddrs(first);
  return interfaces;
}

struct Asked {
  explicit Asked(const NetworkInterface& through) : interface(through), socket(through.address, through.index) {}
  NetworkInterface interface;
  GvcpSocket socket;
  std::uint16_t request = 0;

  void ask(std::uint32_t to) {
    const bool everybody = to == kEverybody;
    request = socket.send(to, gvcp::kDiscovery,
                          everybody ? gvcp::kAcknowledged | gvcp::kAcknowledgedToEverybody : gvcp::kAcknowledged, {});
  }
};

/// Answers to one discovery, each camera once: through an interface whose subnet fits, if it answers through one.
void collect(Asked& asked, std::uint16_t request, SteadyClock::time_point until, std::vector<FoundCamera>& found) {
  for (int answers = 0; answers < kMostAnswers; ++answers) {
    const auto ack = asked.socket.receive(gvcp::kDiscovery, request, until);
    if (!ack) return;
    auto camera = ack->status == 0 ? camera_of_answer(ack->payload) : std::nullopt;
    if (!camera) continue;
    if (asked.interface.address != 0) {
      camera->interface = asked.interface.name;
      camera->interface_address = gvcp::address_text(asked.interface.address);
      camera->subnet_fits = fits(asked.interface, *camera);
    }
    const auto known = std::find_if(found.begin(), found.end(), [&](const FoundCamera& other) {
      return other.mac == camera->mac && other.address == camera->address;
    });
    if (known == found.end()) {
      found.push_back(std::move(*camera));
    } else if (camera->subnet_fits && !known->subnet_fits) {
      *known = std::move(*camera);
    }
  }
}

/// A question through every interface that takes it; reason: why one does not.
std::list<Asked> ask_everybody(const std::vector<NetworkInterface>& interfaces, std::string& reason) {
  std::list<Asked> asked;
  for (const NetworkInterface& interface : interfaces) {
    try {
      asked.emplace_back(interface).ask(kEverybody);
    } catch (const Error& error) {
      reason = interface.name + ": " + error.what();
      if (!asked.empty() && asked.back().request == 0) asked.pop_back();
    }
  }
  return asked;
}

std::list<Asked> ask_at(std::uint32_t address) {
  std::list<Asked> asked;
  asked.emplace_back(NetworkInterface{}).ask(address);
  return asked;
}

}  // namespace

std::optional<FoundCamera> camera_of_answer(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < kAnswerBytes) return std::nullopt;
  FoundCamera camera;
  camera.mac = mac_text(bytes);
  camera.ip_configuration = gvcp::get32(bytes, 0x14) & 0x7U;
  camera.address = gvcp::address_text(gvcp::get32(bytes, 0x24));
  camera.mask = gvcp::address_text(gvcp::get32(bytes, 0x34));
  camera.gateway = gvcp::address_text(gvcp::get32(bytes, 0x44));
  camera.vendor = text_at(bytes, 0x48, 32);
  camera.model = text_at(bytes, 0x68, 32);
  camera.firmware = text_at(bytes, 0x88, 32);
  camera.serial = text_at(bytes, 0xD8, 16);
  camera.user_name = text_at(bytes, 0xE8, 16);
  return camera;
}

std::vector<NetworkInterface> network_interfaces(const std::string& named) {
  auto interfaces = interfaces_that([&named](const NetworkInterface& interface, bool loopback) {
    return named.empty() ? !loopback : named == interface.name || named == gvcp::address_text(interface.address);
  });
  if (interfaces.empty() && !named.empty()) {
    throw Error(ErrorCode::kBadInput, "there is no network interface '" + named +
                                          "' with an IPv4 address that is up; see: ip -brief address");
  }
  return interfaces;
}

std::vector<NetworkInterface> all_network_interfaces() {
  return interfaces_that([](const NetworkInterface&, bool) { return true; });
}

std::vector<FoundCamera> discover_cameras(const std::vector<NetworkInterface>& interfaces, milliseconds patience) {
  std::string reason;
  std::list<Asked> asked = ask_everybody(interfaces, reason);
  if (asked.empty() && !reason.empty()) throw Error(ErrorCode::kCameraDisconnected, reason);
  const auto until = SteadyClock::now() + patience;  // the same for all: they answer at once
  std::vector<FoundCamera> all;
  for (Asked& one : asked) {
    std::vector<FoundCamera> found;
    collect(one, one.request, until, found);
    for (FoundCamera& camera : found) {
      if (camera.subnet_fits) ask_control(one.socket, camera);
      all.push_back(std::move(camera));
    }
  }
  std::sort(all.begin(), all.end(), [](const FoundCamera& a, const FoundCamera& b) {
    return std::tie(a.interface, a.address, a.mac) < std::tie(b.interface, b.address, b.mac);
  });
  return all;
}

std::optional<FoundCamera> identify_camera(std::uint32_t address, milliseconds patience) {
  const auto end = SteadyClock::now() + patience;
  std::list<Asked> asked = ask_at(address);
  std::vector<FoundCamera> found;
  while (found.empty() && SteadyClock::now() < end) {
    Asked& one = asked.front();
    const auto ack = one.socket.receive(gvcp::kDiscovery, one.request, std::min(end, SteadyClock::now() + kRepeat));
    auto camera = ack && ack->status == 0 ? camera_of_answer(ack->payload) : std::nullopt;
    if (camera) return camera;
    one.ask(address);
  }
  return std::nullopt;
}

std::optional<FoundCamera> discover_camera_at(std::uint32_t address, milliseconds patience) {
  auto camera = identify_camera(address, patience);
  if (!camera) return camera;
  GvcpSocket socket;
  ask_control(socket, *camera);
  return camera;
}

std::vector<FoundCamera> look_for_camera(const std::string& wanted, std::uint32_t address, milliseconds patience) {
  std::vector<FoundCamera> found;
  try {
    std::string reason;
    std::list<Asked> asked = address != 0 ? ask_at(address) : ask_everybody(all_network_interfaces(), reason);
    auto end = SteadyClock::now() + patience;
    auto repeat_at = SteadyClock::now() + kRepeatSearch;
    bool seen = false;
    while (!asked.empty() && SteadyClock::now() < end) {
      for (Asked& one : asked) collect(one, kAnyRequest, SteadyClock::now() + kTurn, found);
      if (seen) continue;
      seen = std::any_of(found.begin(), found.end(), [&](const FoundCamera& one) { return one.is_called(wanted); });
      if (seen) {
        end = std::min(end, SteadyClock::now() + kForOthers);
      } else if (SteadyClock::now() >= repeat_at) {
        for (Asked& one : asked) one.ask(address != 0 ? address : kEverybody);
        repeat_at = SteadyClock::now() + kRepeatSearch;
      }
    }
  } catch (const Error&) {  // an interface that has just gone
  }
  // In one order whoever answers first: messages that list them are the same each time.
  std::sort(found.begin(), found.end(), [](const FoundCamera& a, const FoundCamera& b) {
    return std::tie(a.address, a.mac) < std::tie(b.address, b.mac);
  });
  return found;
}

}  // namespace fvd
