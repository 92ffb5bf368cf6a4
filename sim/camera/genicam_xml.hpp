#pragma once

/// The GenICam description of the simulated camera: SFNC names over the registers of camera_registers.hpp.

#include <string>

namespace fvd::sim {

[[nodiscard]] std::string genicam_xml(int width_increment);

}  // namespace fvd::sim
