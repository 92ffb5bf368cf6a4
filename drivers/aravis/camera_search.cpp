#include "drivers/aravis/camera_search.hpp"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <iterator>
#include <vector>

#include <spdlog/spdlog.h>

#include "core/base/error.hpp"
#include "drivers/aravis/usb_cameras.hpp"
#include "drivers/gige/camera_discovery.hpp"
#include "drivers/gige/gvcp_socket.hpp"

namespace fvd {

namespace {

using std::chrono::milliseconds;

/// A camera answers a discovery within this time, unless it was told to wait.
constexpr milliseconds kSearchTime{600};
constexpr milliseconds kIdentifyTime{200};

std::string listed(const std::vector<FoundCamera>& cameras) {
  std::string all;
  for (const FoundCamera& camera : cameras) all += (all.empty() ? "" : "; ") + camera.text();
  return all;
}

[[noreturn]] void throw_not_found(const std::string& name, const std::vector<FoundCamera>& network,
                                  const std::optional<std::vector<FoundCamera>>& usb) {
  std::string message = "no camera is called '" + name + "': ";
  message += network.empty()
                 ? "no GigE Vision camera answers"
                 : std::to_string(network.size()) + " GigE Vision camera(s) answer (" + listed(network) + ")";
  if (!usb) {
    message += "; this system has no USB bus";
  } else if (usb->empty()) {
    message += "; no USB3 Vision camera is plugged in";
  } else {
    message += "; " + std::to_string(usb->size()) + " USB3 Vision camera(s) are plugged in (" + listed(*usb) + ")";
  }
  throw Error(ErrorCode::kCameraDisconnected, message + "; is it powered, and camera.address right?");
}

CameraTarget find_usb_camera(const std::string& name, const std::vector<FoundCamera>& network) {
  const auto usb = list_usb_cameras();
  if (!usb) throw_not_found(name, network, usb);
  const auto found =
      std::find_if(usb->begin(), usb->end(), [&](const FoundCamera& one) { return one.is_called(name); });
  if (found == usb->end()) throw_not_found(name, network, usb);
  if (!found->accessible) {
    throw Error(ErrorCode::kCameraDisconnected,
                "no permission for the camera " + found->id() + " (" + found->node +
                    "): install the udev rule 60-fvd-cameras.rules, add its vendor if it is missing there, and plug "
                    "the camera in again");
  }
  return {name, found->serial, std::nullopt};
}

/// Nothing if the camera does not tell, or nothing can be sent to it; opening it says why.
std::optional<FoundCamera> identity_at(std::uint32_t ip) {
  try {
    auto camera = identify_camera(ip, kIdentifyTime);
    if (camera) camera->address = gvcp::address_text(ip);
    return camera;
  } catch (const Error& error) {
    spdlog::debug("{}", error.what());
    return std::nullopt;
  }
}

/// A camera hears a broadcast and answers to everybody whatever its address is; nothing else works across subnets.
void require_reachable(const FoundCamera& camera) {
  if (camera.subnet_fits || identity_at(gvcp::address_of(camera.address).value_or(0))) return;
  throw Error(ErrorCode::kCameraDisconnected,
              "the camera " + camera.text() + ", mask " + camera.mask + ", is not in the subnet of " +
                  camera.interface + " (" + camera.interface_address +
                  ") and cannot be reached there; give it another address: fvdctl camera set-ip " + camera.serial +
                  " --interface " + camera.interface + " --address ...");
}

/// 0 = everywhere
std::uint32_t search_address(const CameraConfig& config) {
  if (config.search_address.empty()) return 0;
  if (const auto address = gvcp::address_of(config.search_address)) return *address;
  throw Error(ErrorCode::kBadConfig,
              "'" + config.search_address + "' is no IPv4 address: /camera/search_address takes e.g. 192.168.1.255");
}

}  // namespace

void require_serial(const CameraConfig& config, const std::string& serial, const std::string& what) {
  if (config.serial.empty() || same_name(config.serial, serial)) return;
  throw Error(ErrorCode::kCameraDisconnected, "another camera is at " + config.address + ": " + what +
                                                  ", and camera.serial expects " + config.serial +
                                                  "; nothing was changed in it");
}

CameraTarget find_camera(const CameraConfig& config) {
  const std::string& name = config.address;
  if (name.empty()) {
    throw Error(ErrorCode::kBadConfig,
                "the camera's address is empty: give its IP address, serial number, MAC, user-defined name or "
                "vendor-model-serial in /camera/address");
  }
  CameraTarget target{name, name, std::nullopt};
  if (const auto ip = gvcp::address_of(name)) {
    target.identity = identity_at(*ip);
  } else {
    const auto network = look_for_camera(name, search_address(config), kSearchTime);
    std::vector<FoundCamera> called;
    std::copy_if(network.begin(), network.end(), std::back_inserter(called),
                 [&](const FoundCamera& one) { return one.is_called(name); });
    if (called.size() > 1) {
      throw Error(ErrorCode::kCameraDisconnected, std::to_string(called.size()) + " cameras are called '" + name +
                                                      "': " + listed(called) +
                                                      "; give the MAC of one in camera.address");
    }
    if (called.empty()) return find_usb_camera(name, network);
    require_reachable(called.front());
    target = {name + " (" + called.front().address + ")", called.front().address, called.front()};
  }
  if (target.identity) require_serial(config, target.identity->serial, target.identity->text());
  return target;
}

}  // namespace fvd
