#pragma once

/// The GenICam description of the simulated camera: SFNC names over the registers of camera_registers.hpp.

#include <string>

namespace fvd::sim {

/// What cameras differ in.
struct DescriptionOptions {
  int width_increment = 1;  ///< pixels
  bool chunk_mode = false;  ///< with ChunkModeActive
};

[[nodiscard]] std::string genicam_xml(const DescriptionOptions& options);

}  // namespace fvd::sim
