#include "sim/evaluate/truth_file.hpp"

#include <cmath>
#include <fstream>

#include <nlohmann/json.hpp>

#include "core/base/error.hpp"
#include "sim/artefact/cutting_edge.hpp"
#include "sim/artefact/stepped_artefacts.hpp"
#include "sim/world/artefact_surface.hpp"

namespace fvd::sim {

namespace {

using nlohmann::ordered_json;

ordered_json place_json(const WorldParameters& world, const Place& place) {
  const Place corner = grid_of(world).from_corner(place);
  return ordered_json::array({corner.x_um, corner.y_um});
}

template <typename Value>
ordered_json or_null(const std::optional<Value>& value) {
  return value ? ordered_json(*value) : ordered_json(nullptr);
}

double slope_of(const Tilt& tilt) { return std::hypot(tilt.slope_x, tilt.slope_y); }

/// What a height along z is perpendicular to the tilted plane.
double perpendicular(const WorldParameters& world, double height_um) {
  return height_um / std::hypot(1.0, slope_of(world.artefacts.tilt));
}

ordered_json tilt_json(const Tilt& tilt) {
  return {{"slope_x", tilt.slope_x}, {"slope_y", tilt.slope_y}, {"angle_deg", degrees(std::atan(slope_of(tilt)))}};
}

ordered_json contrast_json(const WorldParameters& world) {
  const double reach_um = grid_of(world).reach_um();
  const auto within = [&](double um) { return std::clamp(um, -reach_um, reach_um); };
  ordered_json regions = ordered_json::array();
  for (const ContrastRegion& region : world.artefacts.contrast.regions) {
    const Directed direction(region.direction_deg);
    ordered_json corners = ordered_json::array();
    const double along[4] = {region.along_from_um, region.along_to_um, region.along_to_um, region.along_from_um};
    const double across[4] = {region.across_from_um, region.across_from_um, region.across_to_um, region.across_to_um};
    for (int i = 0; i < 4; ++i) corners.push_back(place_json(world, direction.at(within(along[i]), within(across[i]))));
    regions.push_back({{"polygon_um", corners}, {"contrast_percent", region.contrast_percent}});
  }
  return regions;
}

ordered_json truth_of(const WorldParameters& world, const Groove& groove) {
  return {{"width_um", groove.width_um},
          {"depth_um", groove.depth_um},
          {"depth_perpendicular_um", perpendicular(world, groove.depth_um)},
          {"wall_angle_deg", groove.wall_angle_deg},
          {"wall_run_um", wall_run_um(groove)},
          {"direction_deg", groove.direction_deg},
          {"centre_um", place_json(world, {})}};
}

ordered_json truth_of(const WorldParameters& world, const Stairs& stairs) {
  ordered_json treads = ordered_json::array();
  ordered_json steps = ordered_json::array();
  double from = 0.0;
  for (const Tread& tread : stairs.treads) from -= 0.5 * tread.width_um;
  for (std::size_t i = 0; i < stairs.treads.size(); ++i) {
    const Tread& tread = stairs.treads[i];
    const Directed direction(stairs.direction_deg);
    treads.push_back({{"height_um", tread.height_um},
                      {"width_um", tread.width_um},
                      {"centre_um", place_json(world, direction.at(0.0, from + 0.5 * tread.width_um))}});
    from += tread.width_um;
    if (i == 0) continue;
    const double rise = tread.height_um - stairs.treads[i - 1].height_um;
    steps.push_back({{"height_um", rise}, {"height_perpendicular_um", perpendicular(world, rise)}});
  }
  return {{"direction_deg", stairs.direction_deg}, {"treads", treads}, {"steps", steps}};
}

ordered_json truth_of(const WorldParameters& /*world*/, const Sinusoid& sinusoid) {
  return {{"amplitude_um", sinusoid.amplitude_um},
          {"wavelength_um", sinusoid.wavelength_um},
          {"phase_deg", sinusoid.phase_deg},
          {"direction_deg", sinusoid.direction_deg},
          {"Sa_um", sinusoid.amplitude_um * 2.0 / std::numbers::pi},
          {"Sq_um", sinusoid.amplitude_um / std::numbers::sqrt2},
          {"Sz_um", sinusoid.amplitude_um * 2.0}};
}

ordered_json truth_of(const WorldParameters& world, const Star& star) {
  return {{"pairs", star.pairs},
          {"height_um", star.height_um},
          {"radius_um", star.radius_um},
          {"direction_deg", star.direction_deg},
          {"centre_um", place_json(world, {})},
          {"sector_width_per_radius", std::numbers::pi / star.pairs}};
}

ordered_json truth_of(const WorldParameters& world, const CrossGrid& grid) {
  return {{"pitch_x_um", grid.pitch_x_um},       {"pitch_y_um", grid.pitch_y_um},       {"angle_deg", grid.angle_deg},
          {"direction_deg", grid.direction_deg}, {"line_width_um", grid.line_width_um}, {"height_um", grid.height_um},
          {"crossing_um", place_json(world, {})}};
}

ordered_json truth_of(const WorldParameters& world, const LetterF& letter) {
  ordered_json all = ordered_json::array();
  for (const Stroke& stroke : strokes(letter)) {
    const Place corner = grid_of(world).from_corner({stroke.x_um, stroke.y_um});
    all.push_back({{"x", corner.x_um}, {"y", corner.y_um}, {"width", stroke.width_um}, {"height", stroke.height_um}});
  }
  return {{"size_um", letter.size_um}, {"height_um", letter.height_um}, {"rectangles_um", all}};
}

const char* side_of(const Place& towards) {
  if (std::abs(towards.x_um) > std::abs(towards.y_um)) return towards.x_um < 0.0 ? "left" : "right";
  return towards.y_um < 0.0 ? "top" : "bottom";
}

ordered_json notches_json(const WorldParameters& world, const EdgeSurface& surface) {
  ordered_json notches = ordered_json::array();
  for (const Notch& notch : world.artefacts.edge.notches) {
    notches.push_back({{"position_um", notch.position_um},
                       {"at_um", place_json(world, surface.place(notch.position_um, 0.0))},
                       {"width_um", notch.width_um},
                       {"depth_um", notch.depth_um},
                       {"area_um2", notch.depth_um * notch.width_um}});
  }
  return notches;
}

ordered_json truth_of(const WorldParameters& world, const CuttingEdge& edge) {
  const EdgeSurface surface(edge, world.artefacts.tilt);
  const WedgeTruth& wedge = surface.section().truth();
  const Directed direction(edge.direction_deg);
  const Place towards = direction.at(0.0, -1.0);
  return {{"direction_deg", edge.direction_deg},
          {"rake_side", side_of(towards)},
          {"rake_towards", {{"x", towards.x_um}, {"y", towards.y_um}}},
          {"apex_um", place_json(world, {})},
          {"lean_deg", degrees(std::atan(direction.across(world.artefacts.tilt)))},
          {"beta_deg", wedge.beta_deg},
          {"radius_um", or_null(wedge.radius_um)},
          {"S_gamma_um", wedge.s_gamma_um},
          {"S_alpha_um", wedge.s_alpha_um},
          {"K", or_null(wedge.k)},
          {"weight", wedge.weight},
          {"Delta_r_um", wedge.delta_r_um},
          {"phi_deg", or_null(wedge.phi_deg)},
          {"r_min_um", wedge.r_min_um},
          {"bend_radius_um", or_null(edge.bend_radius_um)},
          {"notches", notches_json(world, surface)}};
}

ordered_json truth_of_sphere(const WorldParameters& world) {
  return {{"radius_um", world.radius_um}, {"cap_height_um", world.cap_height_um}, {"centre_um", place_json(world, {})}};
}

/// The kind's name, and its own dimensions; null for those that only the height map tells.
std::pair<const char*, ordered_json> kind_of(const WorldParameters& world) {
  const Artefacts& artefacts = world.artefacts;
  switch (world.surface) {
    case SurfaceKind::kChapter:
      return {"chapter", nullptr};
    case SurfaceKind::kTilted:
      return {"tilted",
              {{"slope_x", world.tilt_x_um_per_px / world.pixel_pitch_um},
               {"slope_y", world.tilt_y_um_per_px / world.pixel_pitch_um}}};
    case SurfaceKind::kSphere:
      return {"sphere", truth_of_sphere(world)};
    case SurfaceKind::kRough:
      return {"rough", {{"Sq_um", world.sq_um}, {"correlation_px", world.correlation_px}}};
    case SurfaceKind::kHeightMap:
      return {"height_map", nullptr};
    case SurfaceKind::kLayered:
      return {"layered", {{"layer_gap_um", world.layer_gap_um}, {"edge_radius_px", world.edge_radius_px}}};
    case SurfaceKind::kFlat:
      return {"flat", nullptr};
    case SurfaceKind::kGroove:
      return {"groove", truth_of(world, artefacts.groove)};
    case SurfaceKind::kStairs:
      return {"stairs", truth_of(world, artefacts.stairs)};
    case SurfaceKind::kSinusoid:
      return {"sinusoid", truth_of(world, artefacts.sinusoid)};
    case SurfaceKind::kStar:
      return {"star", truth_of(world, artefacts.star)};
    case SurfaceKind::kCrossGrid:
      return {"cross_grid", truth_of(world, artefacts.cross_grid)};
    case SurfaceKind::kLetterF:
      return {"letter_f", truth_of(world, artefacts.letter_f)};
    case SurfaceKind::kEdge:
      return {"edge", truth_of(world, artefacts.edge)};
  }
  return {"", nullptr};
}

}  // namespace

void write_truth_file(const WorldParameters& world, const std::filesystem::path& folder) {
  auto [name, dimensions] = kind_of(world);
  const ordered_json truth{{"surface", name},
                           {"width_px", world.width_px},
                           {"height_px", world.height_px},
                           {"pixel_pitch_um", world.pixel_pitch_um},
                           {"base_um", world.base_um},
                           {"tilt", tilt_json(world.artefacts.tilt)},
                           {"contrast_regions", contrast_json(world)},
                           {name, dimensions}};
  std::ofstream out(folder / "truth.json");
  out << truth.dump(2) << '\n';
  out.close();
  if (!out) throw Error(ErrorCode::kStorageWrite, "cannot write " + (folder / "truth.json").string());
}

}  // namespace fvd::sim
