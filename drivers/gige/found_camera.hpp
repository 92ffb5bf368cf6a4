#pragma once

/// What a camera says of itself before anybody opens it.

#include <cstdint>
#include <string>

namespace fvd {

enum class CameraLink { kGigE, kUsb };

/// Whether a program controls the camera, which then refuses everybody else.
enum class CameraControl { kUnknown, kFree, kControlled };

/// Letters of either case are the same; nothing is the same as an empty text.
[[nodiscard]] bool same_name(const std::string& a, const std::string& b);

struct FoundCamera {
  CameraLink link = CameraLink::kGigE;
  std::string vendor;
  std::string model;
  std::string serial;
  std::string firmware;   ///< "device version"
  std::string user_name;  ///< that somebody gave it; may be empty
  std::string mac;        ///< "00:11:22:aa:bb:cc"; empty for USB
  std::string address;    ///< GigE: its IP address; USB: vendor-model-serial. What camera.address takes

  // GigE only.
  std::string mask;                    ///< of its subnet
  std::string gateway;                 ///< "0.0.0.0" = none
  std::uint32_t ip_configuration = 0;  ///< current: 1 persistent, 2 DHCP, 4 link-local, added up
  std::string interface;               ///< of this machine, through which it answered, e.g. "eth1"
  std::string interface_address;       ///< and the address of that
  bool subnet_fits = true;             ///< false: it cannot be opened before one of the two addresses changes
  CameraControl control = CameraControl::kUnknown;
  std::string controller;  ///< "192.168.10.2:51000" where the camera tells; empty = it does not

  // USB only.
  std::string node;        ///< its file below /dev/bus/usb
  bool accessible = true;  ///< this process may open it

  /// vendor-model-serial
  [[nodiscard]] std::string id() const { return vendor + "-" + model + "-" + serial; }
  /// "vendor-model-serial at 192.168.1.20, MAC 00:11:22:aa:bb:cc, named left"
  [[nodiscard]] std::string text() const;
  /// Whether the name is its IP address, MAC (with : or - or neither), serial number, user-defined name or
  /// vendor-model-serial, in letters of either case.
  [[nodiscard]] bool is_called(const std::string& name) const;
};

}  // namespace fvd
