#include "sim/world/sim_world.hpp"

#include "sim/world/texture.hpp"

namespace fvd::sim {

SimWorld::SimWorld(const WorldParameters& parameters, const AxisModel& axis)
    : axis_(axis),
      surface_(make_surface(parameters)),
      renderer_(make_texture(parameters.texture, surface_.poor, parameters.contrast, parameters.poor_contrast,
                             parameters.seed),
                surface_.height_um,
                {.defocus_px_per_um = parameters.defocus_px_per_um,
                 .readout_noise = parameters.readout_noise,
                 .seed = parameters.seed}) {}

void SimWorld::render(const ExposureRequest& request, std::span<std::byte> out) {
  constexpr int kPositionSamples = 5;
  double z_um = 0.0;
  for (int i = 0; i < kPositionSamples; ++i) {
    z_um += axis_.true_position_um(request.start + (request.end - request.start) * i / (kPositionSamples - 1)) /
            kPositionSamples;
  }
  renderer_.render(z_um, request, out);
}

}  // namespace fvd::sim
