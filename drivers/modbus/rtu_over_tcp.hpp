#pragma once

/// Finds a serial device server that passes bytes on as they are: it takes connections, and serial frames in them.

#include <chrono>

#include "drivers/modbus/modbus_transport.hpp"

namespace fvd {

/// Asks for one register in a serial frame on a connection of its own; true if a serial frame of the unit comes back,
/// an exception too. A server of one client answers only once all other connections to it are closed.
/// Throws nothing. context: blocks for two timeouts at most.
[[nodiscard]] bool answers_serial_frames(const ModbusTcpEndpoint& endpoint, int unit,
                                         std::chrono::milliseconds timeout);

}  // namespace fvd
