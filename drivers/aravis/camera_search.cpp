#include "drivers/aravis/camera_search.hpp"

#include <algorithm>
#include <cctype>

#include <arpa/inet.h>

#include "core/base/error.hpp"

namespace fvd {

namespace {

using std::chrono::milliseconds;

/// A camera answers a discovery within this time, unless it was told to wait.
constexpr milliseconds kSearchTime{600};
constexpr milliseconds kIdentifyTime{200};

std::string lower(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

bool same(const std::string& a, const std::string& b) { return !a.empty() && lower(a) == lower(b); }

std::string without_separators(const std::string& mac) {
  std::string digits;
  for (const char c : mac) {
    if (c != ':' && c != '-') digits += c;
  }
  return digits;
}

template <typename Camera>
std::string listed(const std::vector<Camera>& cameras, std::string (Camera::*text)() const) {
  std::string all;
  for (const Camera& camera : cameras) all += (all.empty() ? "" : "; ") + (camera.*text)();
  return all;
}

[[noreturn]] void throw_not_found(const std::string& name, const std::vector<FoundCamera>& network,
                                  const std::optional<std::vector<UsbCamera>>& usb) {
  std::string message = "no camera is called '" + name + "': ";
  message += network.empty() ? "no GigE Vision camera answers"
                             : std::to_string(network.size()) + " GigE Vision camera(s) answer (" +
                                   listed(network, &FoundCamera::text) + ")";
  if (!usb) {
    message += "; this system has no USB bus";
  } else if (usb->empty()) {
    message += "; no USB3 Vision camera is plugged in";
  } else {
    message += "; " + std::to_string(usb->size()) + " USB3 Vision camera(s) are plugged in (" +
               listed(*usb, &UsbCamera::id) + ")";
  }
  throw Error(ErrorCode::kCameraDisconnected, message + "; is it powered, and camera.address right?");
}

CameraTarget find_usb_camera(const std::string& name, const std::vector<FoundCamera>& network) {
  const auto usb = list_usb_cameras();
  if (!usb) throw_not_found(name, network, usb);
  const auto found = std::find_if(usb->begin(), usb->end(), [&](const UsbCamera& one) { return one.is_called(name); });
  if (found == usb->end()) throw_not_found(name, network, usb);
  if (!found->accessible) {
    throw Error(ErrorCode::kCameraDisconnected,
                "no permission for the camera " + found->id() + " (" + found->node +
                    "): install the udev rule 60-fvd-cameras.rules, add its vendor if it is missing there, and plug "
                    "the camera in again");
  }
  return {name, found->serial, std::nullopt};
}

}  // namespace

bool is_ipv4(const std::string& text) {
  in_addr address{};
  return ::inet_pton(AF_INET, text.c_str(), &address) == 1;
}

std::string FoundCamera::text() const {
  return id() + " at " + ip + ", MAC " + mac + (user_name.empty() ? "" : ", named " + user_name);
}

bool FoundCamera::is_called(const std::string& name) const {
  return same(ip, name) || same(serial, name) || same(user_name, name) || same(id(), name) ||
         same(without_separators(mac), without_separators(name));
}

bool UsbCamera::is_called(const std::string& name) const { return same(serial, name) || same(id(), name); }

void require_serial(const CameraConfig& config, const std::string& serial, const std::string& what) {
  if (config.serial.empty() || same(config.serial, serial)) return;
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
  if (is_ipv4(name)) {
    target.identity = identify_camera(name, kIdentifyTime);
  } else {
    const auto network = search_cameras(config.search_address, kSearchTime, name);
    std::vector<FoundCamera> called;
    std::copy_if(network.begin(), network.end(), std::back_inserter(called),
                 [&](const FoundCamera& one) { return one.is_called(name); });
    if (called.size() > 1) {
      throw Error(ErrorCode::kCameraDisconnected, std::to_string(called.size()) + " cameras are called '" + name +
                                                      "': " + listed(called, &FoundCamera::text) +
                                                      "; give the MAC of one in camera.address");
    }
    if (called.empty()) return find_usb_camera(name, network);
    target = {name + " (" + called.front().ip + ")", called.front().ip, called.front()};
  }
  if (target.identity) require_serial(config, target.identity->serial, target.identity->text());
  return target;
}

}  // namespace fvd
