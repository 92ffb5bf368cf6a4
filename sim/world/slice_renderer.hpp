#pragma once

/// What makes slices of a world.

#include <cstddef>
#include <span>

#include "sim/world/frame_source.hpp"

namespace fvd::sim {

/// context: one thread.
class SliceRenderer {
 public:
  virtual ~SliceRenderer() = default;
  /// Renders the region with the focal plane at z_um; the times of the request are not looked at. out: as
  /// FrameSource::render.
  virtual void render(double z_um, const ExposureRequest& request, std::span<std::byte> out) = 0;
  [[nodiscard]] virtual std::size_t memory_bytes() const = 0;
};

}  // namespace fvd::sim
