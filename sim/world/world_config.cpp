#include "sim/world/world_config.hpp"

#include <algorithm>
#include <array>

#include "config/field_reader.hpp"
#include "config/strict_json.hpp"
#include "sim/world/artefact_config.hpp"
#include "sim/world/artefact_surface.hpp"

namespace fvd::sim {

namespace {

const std::vector<std::string> kSurfaces{"chapter", "tilted", "sphere",   "rough", "height_map", "layered",  "flat",
                                         "groove",  "stairs", "sinusoid", "star",  "cross_grid", "letter_f", "edge"};
const std::vector<std::string> kTextures{"granite", "fine", "white"};
const std::vector<std::string> kFeedbacks{"motor_encoder", "linear_scale"};

void describe(WorldParameters& world, Fields& fields) {
  std::string surface = kSurfaces[static_cast<std::size_t>(world.surface)];
  std::string file = world.height_map_file.string();
  fields.choice("surface", surface, kSurfaces, "what lies under the microscope");
  fields.require("surface");
  fields.integer("width_px", world.width_px, {16, 8192}, "sensor width");
  fields.integer("height_px", world.height_px, {16, 8192}, "sensor height");
  fields.number("tilt_x_um_per_px", world.tilt_x_um_per_px, {-10.0, 10.0}, "tilted: rise per pixel");
  fields.number("tilt_y_um_per_px", world.tilt_y_um_per_px, {-10.0, 10.0}, "tilted: rise per pixel");
  fields.number("base_um", world.base_um, {-10000.0, 10000.0},
                "height of the centre, the (far) plane, the mean, or an artefact's 0");
  fields.number("radius_um", world.radius_um, positive(1e6), "sphere: radius");
  fields.number("cap_height_um", world.cap_height_um, positive(1e6), "sphere: apex above the plane");
  fields.number("pixel_pitch_um", world.pixel_pitch_um, positive(1000.0), "lateral scale of sphere and artefacts");
  fields.number("sq_um", world.sq_um, {0.0, 1000.0}, "rough: root mean square height");
  fields.number("correlation_px", world.correlation_px, positive(1000.0), "rough: smoothing");
  fields.text("height_map_file", file, 4096, "height_map: a GSF file");
  fields.number("layer_gap_um", world.layer_gap_um, positive(10000.0), "layered: from the far plane to the near one");
  fields.number("edge_radius_px", world.edge_radius_px, {0.0, 8192.0}, "layered: of the near disc; 0: the left half");
  fields.number("near_grey", world.near.grey, {0.0, 255.0}, "layered: mean of the near plane in 8-bit grey levels");
  fields.number("near_contrast", world.near.contrast, {0.0, 31.0}, "layered: standard deviation of its texture");
  fields.number("far_grey", world.far.grey, {0.0, 255.0}, "layered: mean of the far plane in 8-bit grey levels");
  fields.number("far_contrast", world.far.contrast, {0.0, 31.0}, "layered: standard deviation of its texture");
  fields.number("defocus_px_per_um", world.defocus_px_per_um, positive(10.0), "sigma of the blur per um of defocus");
  fields.number("readout_noise", world.readout_noise, {0.0, 50.0}, "standard deviation in 8-bit grey levels");
  std::string texture = kTextures[static_cast<std::size_t>(world.texture)];
  fields.choice("texture", texture, kTextures, "grains of the surface");
  world.texture = static_cast<TextureKind>(std::find(kTextures.begin(), kTextures.end(), texture) - kTextures.begin());
  fields.number("contrast", world.contrast, {0.0, 31.0}, "standard deviation of the texture in 8-bit grey levels");
  fields.number("poor_contrast", world.poor_contrast, {0.0, 1.0}, "contrast of the texture-poor patch, a fraction");
  fields.boolean("mirror_x", world.mirror_x, "the camera shows left and right exchanged");
  fields.boolean("mirror_y", world.mirror_y, "the camera shows top and bottom exchanged");
  fields.integer("seed", world.seed, {0, INT64_MAX}, "of texture, surface and noise");
  world.surface = static_cast<SurfaceKind>(std::find(kSurfaces.begin(), kSurfaces.end(), surface) - kSurfaces.begin());
  world.height_map_file = file;
  describe_artefact(world, fields);
}

void describe(AxisParameters& plant, Fields& fields) {
  fields.number("steps_per_um", plant.steps_per_um, positive(1e6), "commanded steps per um");
  fields.number("encoder_resolution_um", plant.encoder_resolution_um, {0.0, 100.0}, "encoder quantum");
  fields.number("encoder_noise_um", plant.encoder_noise_um, {0.0, 100.0}, "standard deviation of a reading");
  fields.number("settle_noise_um", plant.settle_noise_um, {0.0, 100.0}, "standard deviation of the resting position");
  fields.number("ring_amplitude_um", plant.ring_amplitude_um, {0.0, 100.0}, "oscillation after a move");
  fields.number("ring_frequency_hz", plant.ring_frequency_hz, positive(10000.0), "its frequency");
  fields.number("ring_decay_ms", plant.ring_decay_ms, positive(10000.0), "its decay time");
  fields.number("backlash_um", plant.backlash_um, {0.0, 1000.0}, "lost motion on reversal");
  fields.number("lead_error_um", plant.lead_error_um, {0.0, 1000.0}, "amplitude of the periodic screw error");
  fields.number("lead_um", plant.lead_um, positive(1e6), "screw lead");
  fields.number("lead_phase_deg", plant.lead_phase_deg, {-360.0, 360.0}, "phase of that error at motor position 0");
  fields.number("scale_error", plant.scale_error, {-0.1, 0.1}, "true motion over commanded motion, minus 1");
  fields.number("drift_um_per_min", plant.drift_um_per_min, {-1000.0, 1000.0}, "drift with time");
  fields.number("temperature_c", plant.temperature_c, {-40.0, 100.0}, "of the axis, at the start");
  fields.number("temperature_rate_k_per_min", plant.temperature_rate_k_per_min, {-100.0, 100.0}, "how it rises");
  fields.number("drift_um_per_k", plant.drift_um_per_k, {-1000.0, 1000.0}, "drift with temperature");
  std::string feedback = kFeedbacks[static_cast<std::size_t>(plant.feedback)];
  fields.choice("feedback", feedback, kFeedbacks, "what the encoder sits on");
  plant.feedback =
      static_cast<Feedback>(std::find(kFeedbacks.begin(), kFeedbacks.end(), feedback) - kFeedbacks.begin());
  fields.number("start_latency_ms", plant.start_latency_ms, {0.0, 1000.0}, "command to motion");
  fields.number("home_position_um", plant.home_position_um, {-1e6, 1e6}, "where homing ends");
  fields.number("power_on_position_um", plant.power_on_position_um, {-1e6, 1e6}, "where the axis stands at the start");
  fields.boolean("reversed", plant.reversed, "the true position falls as the drive's steps grow");
  fields.integer("seed", plant.seed, {0, INT64_MAX}, "of all noise");
}

template <typename Parameters>
Parameters read(const std::filesystem::path& file, Problems& problems) {
  Parameters parameters;
  read_document(
      read_text_file(file), [&](Fields& fields) { describe(parameters, fields); }, problems);
  return parameters;
}

}  // namespace

WorldParameters load_world(const std::filesystem::path& file) {
  Problems problems;
  auto world = read<WorldParameters>(file, problems);
  if (problems.empty()) {  // else a refused value's default might not go with the others
    for (const BadParameter& bad : bad_parameters(world)) problems.push_back({bad.pointer, bad.message});
  }
  throw_if_any(problems, ErrorCode::kBadConfig, file.string());
  if (world.surface == SurfaceKind::kHeightMap && world.height_map_file.is_relative()) {
    world.height_map_file = file.parent_path() / world.height_map_file;
  }
  std::filesystem::path& picture = world.artefacts.contrast.picture_file;
  if (!picture.empty() && picture.is_relative()) picture = file.parent_path() / picture;
  return world;
}

AxisParameters load_plant(const std::filesystem::path& file) {
  Problems problems;
  const auto plant = read<AxisParameters>(file, problems);
  throw_if_any(problems, ErrorCode::kBadConfig, file.string());
  return plant;
}

}  // namespace fvd::sim
