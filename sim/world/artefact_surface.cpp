#include "sim/world/artefact_surface.hpp"

#include "core/base/error.hpp"
#include "sim/artefact/cutting_edge.hpp"
#include "sim/artefact/stepped_artefacts.hpp"

namespace fvd::sim {

namespace {

/// level_of(place) of every pixel, over the plane through the middle at base_um.
template <typename LevelOf>
ArtefactSurface sampled(const WorldParameters& world, const Tilt& tilt, LevelOf level_of) {
  const PixelGrid grid = grid_of(world);
  ArtefactSurface surface{Plane<float>(grid.width_px, grid.height_px),
                          Plane<std::uint8_t>(grid.width_px, grid.height_px)};
  for (int y = 0; y < grid.height_px; ++y) {
    for (int x = 0; x < grid.width_px; ++x) {
      const Place place = grid.centre(x, y);
      const Level level = level_of(place);
      surface.height_um.at(x, y) = static_cast<float>(world.base_um + plane_um(tilt, place) + level.height_um);
      surface.level.at(x, y) = level.level;
    }
  }
  return surface;
}

ArtefactSurface sampled_edge(const WorldParameters& world) {
  const EdgeSurface edge(world.artefacts.edge, world.artefacts.tilt);
  return sampled(world, Tilt{}, [&](const Place& place) { return Level{edge.height_um(place), 0}; });
}

}  // namespace

std::vector<BadParameter> bad_parameters(const WorldParameters& world) {
  const Artefacts& artefacts = world.artefacts;
  std::vector<BadParameter> bad = bad_parameters(artefacts.contrast);
  std::vector<BadParameter> own;
  if (world.surface == SurfaceKind::kGroove) own = bad_parameters(artefacts.groove);
  if (world.surface == SurfaceKind::kCrossGrid) own = bad_parameters(artefacts.cross_grid);
  if (world.surface == SurfaceKind::kEdge) {
    own = bad_parameters(artefacts.edge, artefacts.tilt, grid_of(world).reach_um());
  }
  bad.insert(bad.end(), own.begin(), own.end());
  return bad;
}

ArtefactSurface make_artefact(const WorldParameters& world) {
  std::string refused;
  for (const BadParameter& bad : bad_parameters(world)) {
    refused += (refused.empty() ? "" : "; ") + bad.pointer + ": " + bad.message;
  }
  if (!refused.empty()) throw Error(ErrorCode::kBadConfig, refused);
  const Artefacts& artefacts = world.artefacts;
  const auto stepped = [&](const auto& artefact) {
    return sampled(world, artefacts.tilt, [&](const Place& place) { return level_at(artefact, place); });
  };
  switch (world.surface) {
    case SurfaceKind::kGroove:
      return stepped(artefacts.groove);
    case SurfaceKind::kStairs:
      return stepped(artefacts.stairs);
    case SurfaceKind::kSinusoid:
      return stepped(artefacts.sinusoid);
    case SurfaceKind::kStar:
      return stepped(artefacts.star);
    case SurfaceKind::kCrossGrid:
      return stepped(artefacts.cross_grid);
    case SurfaceKind::kLetterF:
      return stepped(artefacts.letter_f);
    case SurfaceKind::kEdge:
      return sampled_edge(world);
    default:
      return sampled(world, artefacts.tilt, [](const Place&) { return Level{}; });
  }
}

}  // namespace fvd::sim
