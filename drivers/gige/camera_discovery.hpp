#pragma once

/// Looks for GigE Vision cameras on the networks of this machine. Reads only.

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "drivers/gige/found_camera.hpp"

namespace fvd {

/// An IPv4 address of this machine. Addresses in the host's order.
struct NetworkInterface {
  std::string name;
  int index = 0;
  std::uint32_t address = 0;
  std::uint32_t mask = 0;
};

/// Those that are up. named: only the interface of this name, or of this address; empty = all but the loopback.
/// Throws Error kBadInput if there is none of that name.
[[nodiscard]] std::vector<NetworkInterface> network_interfaces(const std::string& named = {});

/// Asks everybody on the wire of every interface for `patience`, and each camera that can be reached who controls it.
/// Sorted by interface and address. Interfaces that nothing can be sent through are passed over where there are others;
/// throws Error kCameraDisconnected if that is all of them.
[[nodiscard]] std::vector<FoundCamera> discover_cameras(const std::vector<NetworkInterface>& interfaces,
                                                        std::chrono::milliseconds patience = std::chrono::seconds(1));

/// Asks one address, e.g. behind a router that passes no broadcast. Nothing if no camera answers there. Throws Error
/// kCameraDisconnected if there is no way to it.
[[nodiscard]] std::vector<FoundCamera> discover_camera_at(std::uint32_t address,
                                                          std::chrono::milliseconds patience = std::chrono::seconds(1));

}  // namespace fvd
