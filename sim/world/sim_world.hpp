#pragma once

/// The world that camera and drive share: a surface, optics, and the true position of the stage.

#include <cstddef>
#include <memory>
#include <span>

#include "core/image/image.hpp"
#include "core/image/mirror.hpp"
#include "sim/axis/axis_model.hpp"
#include "sim/world/frame_source.hpp"
#include "sim/world/slice_renderer.hpp"
#include "sim/world/surface.hpp"
#include "sim/world/world_parameters.hpp"

namespace fvd::sim {

/// The renderer that the kind of surface wants. Throws what make_surface throws.
[[nodiscard]] std::unique_ptr<SliceRenderer> make_renderer(const WorldParameters& world, const Surface& surface);

/// context: as a FrameSource.
class SimWorld final : public FrameSource {
 public:
  /// axis outlives the world. Throws what make_surface throws.
  SimWorld(const WorldParameters& parameters, const AxisModel& axis);

  [[nodiscard]] int sensor_width() const override { return surface_.height_um.width(); }
  [[nodiscard]] int sensor_height() const override { return surface_.height_um.height(); }
  /// Renders at the mean true position of the axis over the exposure.
  void render(const ExposureRequest& request, std::span<std::byte> out) override;

  [[nodiscard]] const Surface& surface() const { return surface_; }
  [[nodiscard]] std::size_t memory_bytes() const { return renderer_->memory_bytes(); }

 private:
  const AxisModel& axis_;
  const Mirror mirror_;  // of the camera against the surface
  Surface surface_;
  std::unique_ptr<SliceRenderer> renderer_;
};

}  // namespace fvd::sim
