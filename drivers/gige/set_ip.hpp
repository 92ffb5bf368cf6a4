#pragma once

/// Gives a GigE Vision camera another address, also one that cannot be reached by the address it has.

#include <cstdint>
#include <string>

#include "drivers/gige/camera_discovery.hpp"

namespace fvd {

/// Addresses in the host's order.
struct CameraAddress {
  std::uint32_t address = 0;
  std::uint32_t mask = 0;
  std::uint32_t gateway = 0;  ///< 0 = none
};

/// Throws Error kBadInput for an address that no camera can have, a mask with holes, an address that is the network's
/// or its broadcast, a gateway outside of the subnet, the interface's own, or outside the interface's subnet.
void check_address(const CameraAddress& wanted, const NetworkInterface& interface);

/// FORCEIP: the address until the camera is switched off. Returns once the camera answers there. interface: through
/// which it was found. Throws Error as check_address(), kBadInput if another camera answers at the address,
/// kCameraSettings if a program controls it, kCameraDisconnected if it does not answer at its new address within 5 s.
void force_ip(const FoundCamera& camera, const CameraAddress& wanted, const NetworkInterface& interface);

/// The address that the camera has whenever it is switched on: writes it, and switches the persistent address on. The
/// camera must be reachable at `at`; what it uses now does not change. Takes control for the moment. Throws Error
/// kCameraSettings if it refuses or reads back another value, kCameraDisconnected.
void set_persistent_ip(std::uint32_t at, const CameraAddress& wanted);

}  // namespace fvd
