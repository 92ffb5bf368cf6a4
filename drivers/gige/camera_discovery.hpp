#pragma once

/// Looks for GigE Vision cameras on the networks of this machine. Reads only.

#include <chrono>
#include <cstdint>
#include <optional>
#include <span>
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

/// The camera that the payload of a discovery's acknowledge tells of: bootstrap registers from 0 on. Nothing for one
/// that is too short.
[[nodiscard]] std::optional<FoundCamera> camera_of_answer(std::span<const std::uint8_t> payload);

/// Those that are up. named: only the interface of this name, or of this address; empty = all but the loopback.
/// Throws Error kBadInput if there is none of that name.
[[nodiscard]] std::vector<NetworkInterface> network_interfaces(const std::string& named = {});

/// All that are up, the loopback too.
[[nodiscard]] std::vector<NetworkInterface> all_network_interfaces();

/// Asks everybody on the wire of every interface for `patience`, and each camera that can be reached who controls it.
/// Sorted by interface and address. Interfaces that nothing can be sent through are passed over where there are others;
/// throws Error kCameraDisconnected if that is all of them.
[[nodiscard]] std::vector<FoundCamera> discover_cameras(const std::vector<NetworkInterface>& interfaces,
                                                        std::chrono::milliseconds patience = std::chrono::seconds(1));

/// Asks one address, e.g. behind a router that passes no broadcast, and who controls the camera. Nothing if none
/// answers there. Throws Error kCameraDisconnected if there is no way to it.
[[nodiscard]] std::optional<FoundCamera> discover_camera_at(
    std::uint32_t address, std::chrono::milliseconds patience = std::chrono::seconds(1));

/// Who is at an address; asks for nothing else. Throws as discover_camera_at().
[[nodiscard]] std::optional<FoundCamera> identify_camera(std::uint32_t address, std::chrono::milliseconds patience);

/// Asks as discover_cameras() does, at `address` alone if it is not 0 (255.255.255.255 of one subnet, or one camera),
/// and collects what answers within `patience`; ends 0.1 s after one has answered that is called `wanted`, so that
/// another one of that name is seen too. Does not ask who controls them. Never throws: nothing can be sent = nobody
/// answers.
[[nodiscard]] std::vector<FoundCamera> look_for_camera(const std::string& wanted, std::uint32_t address,
                                                       std::chrono::milliseconds patience);

}  // namespace fvd
