#include "sim/world/sim_world.hpp"

#include "sim/world/defocus_renderer.hpp"
#include "sim/world/layered_renderer.hpp"
#include "sim/world/texture.hpp"

namespace fvd::sim {

std::unique_ptr<SliceRenderer> make_renderer(const WorldParameters& world, const Surface& surface) {
  if (world.surface == SurfaceKind::kLayered) return std::make_unique<LayeredRenderer>(world);
  const RendererOptions options{
      .defocus_px_per_um = world.defocus_px_per_um, .readout_noise = world.readout_noise, .seed = world.seed};
  return std::make_unique<DefocusRenderer>(make_texture(world.texture, surface.contrast, world.contrast, world.seed),
                                           surface.height_um, options);
}

SimWorld::SimWorld(const WorldParameters& parameters, const AxisModel& axis)
    : axis_(axis),
      mirror_{parameters.mirror_x, parameters.mirror_y},
      surface_(make_surface(parameters)),
      renderer_(make_renderer(parameters, surface_)) {}

void SimWorld::render(const ExposureRequest& request, std::span<std::byte> out) {
  constexpr int kPositionSamples = 5;
  double z_um = 0.0;
  for (int i = 0; i < kPositionSamples; ++i) {
    z_um += axis_.true_position_um(request.start + (request.end - request.start) * i / (kPositionSamples - 1)) /
            kPositionSamples;
  }
  // The part of the surface that a region of a mirrored sensor looks at lies on the other side.
  ExposureRequest seen = request;
  if (mirror_.x) seen.offset_x = sensor_width() - request.offset_x - request.width;
  if (mirror_.y) seen.offset_y = sensor_height() - request.offset_y - request.height;
  renderer_->render(z_um, seen, out);
  if (bytes_per_pixel(request.format) == 1) {
    auto* const pixels = reinterpret_cast<std::uint8_t*>(out.data());
    mirror_in_place(PlaneView<std::uint8_t>{pixels, request.width, request.height, request.width}, mirror_);
  } else {
    auto* const pixels = reinterpret_cast<std::uint16_t*>(out.data());
    mirror_in_place(PlaneView<std::uint16_t>{pixels, request.width, request.height, request.width}, mirror_);
  }
}

}  // namespace fvd::sim
