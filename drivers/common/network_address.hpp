#pragma once

/// What can be told of a network address without asking the network.

#include <string>

namespace fvd {

/// Why no device can have this address: an IPv4 address that has too large or too many numbers, stands for many
/// machines (broadcast, multicast) or for none (0.0.0.0). Empty for any other text, names included.
[[nodiscard]] std::string why_no_device(const std::string& address);

/// Why nobody can listen on this numeric address: it is none, or stands for many machines. Empty where one can, once a
/// network card of this machine has it.
[[nodiscard]] std::string why_no_listener(const std::string& address);

}  // namespace fvd
