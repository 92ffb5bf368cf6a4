#pragma once

/// Finds the camera that the configuration names. No Aravis in this header.

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "drivers/common/driver_config.hpp"

namespace fvd {

/// What a GigE Vision camera tells everybody who asks, without control.
struct FoundCamera {
  std::string ip;
  std::string mac;  ///< "00:11:22:aa:bb:cc"
  std::string vendor;
  std::string model;
  std::string version;  ///< of the device, usually its firmware
  std::string serial;
  std::string user_name;  ///< DeviceUserID, empty if nobody gave one

  /// vendor-model-serial
  [[nodiscard]] std::string id() const { return vendor + "-" + model + "-" + serial; }
  /// "vendor-model-serial at 192.168.1.20, MAC 00:11:22:aa:bb:cc, named left"
  [[nodiscard]] std::string text() const;
  /// Whether the name is its IP address, MAC (with : or - or neither), serial number, user-defined name or
  /// vendor-model-serial. Letters of either case are the same.
  [[nodiscard]] bool is_called(const std::string& name) const;
};

[[nodiscard]] bool is_ipv4(const std::string& text);

/// Asks the camera at this IP address who it is; nothing if it does not tell within `patience`.
[[nodiscard]] std::optional<FoundCamera> identify_camera(const std::string& ip, std::chrono::milliseconds patience);

/// Asks for all GigE Vision cameras, with a broadcast on every interface, or at `search_address` alone if it is not
/// empty, and collects what answers within `patience`; ends sooner once one has answered that is called `wanted`.
[[nodiscard]] std::vector<FoundCamera> search_cameras(const std::string& search_address,
                                                      std::chrono::milliseconds patience,
                                                      const std::string& wanted = {});

/// A USB3 Vision device as the system lists it.
struct UsbCamera {
  std::string vendor;
  std::string model;
  std::string serial;
  std::string node;         ///< its file below /dev/bus/usb
  bool accessible = false;  ///< this process may open it

  [[nodiscard]] std::string id() const { return vendor + "-" + model + "-" + serial; }
  [[nodiscard]] bool is_called(const std::string& name) const;
};

/// Nothing if the system has no USB bus. sysfs, dev: where the system lists devices; tests pass other folders.
[[nodiscard]] std::optional<std::vector<UsbCamera>> list_usb_cameras(
    const std::filesystem::path& sysfs = "/sys/bus/usb/devices", const std::filesystem::path& dev = "/dev/bus/usb");

/// How the configured camera is opened.
struct CameraTarget {
  std::string name;                     ///< for messages: as configured, with the IP address where that is another
  std::string open_by;                  ///< IP address, or serial number of a USB3 Vision camera
  std::optional<FoundCamera> identity;  ///< of a GigE Vision camera that tells
};

/// Throws Error kBadConfig for an empty address, kCameraDisconnected if no camera, or more than one, is called so, or
/// the one that is has another serial number than config.serial.
[[nodiscard]] CameraTarget find_camera(const CameraConfig& config);

/// Throws Error kCameraDisconnected if `serial` is not config.serial, unless that is empty. what: the camera found.
void require_serial(const CameraConfig& config, const std::string& serial, const std::string& what);

}  // namespace fvd
