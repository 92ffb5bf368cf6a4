#include "sim/world/artefact_config.hpp"

#include <algorithm>
#include <string>

namespace fvd::sim {

namespace {

constexpr NumberRange kDirection{-360.0, 360.0};
constexpr NumberRange kSlope{-2.0, 2.0};
constexpr NumberRange kPlace_um{-1e6, 1e6};

void describe(Tilt& tilt, Fields& fields) {
  fields.number("slope_x", tilt.slope_x, kSlope, "rise over run to the right");
  fields.number("slope_y", tilt.slope_y, kSlope, "rise over run downwards in the image");
}

void describe(ContrastRegion& region, Fields& fields) {
  fields.number("direction_deg", region.direction_deg, kDirection, "of its axis along, from x towards y");
  fields.number("along_from_um", region.along_from_um, kPlace_um, "from the image's middle");
  fields.number("along_to_um", region.along_to_um, kPlace_um, "from the image's middle");
  fields.number("across_from_um", region.across_from_um, kPlace_um, "from the image's middle");
  fields.number("across_to_um", region.across_to_um, kPlace_um, "from the image's middle");
  fields.number("contrast_percent", region.contrast_percent, {0.0, 100.0}, "of the contrast elsewhere");
}

void describe(ContrastMap& contrast, Fields& fields) {
  std::string file = contrast.picture_file.string();
  fields.text("picture_file", file, 4096, "grey, 8 bits, of the sensor's size: 255 is the whole contrast");
  contrast.picture_file = file;
  fields.list("regions", contrast.regions, {0, 32}, "turned rectangles, the last one counts",
              [](Fields& inner, ContrastRegion& region) { describe(region, inner); });
}

void describe(Groove& groove, Fields& fields) {
  fields.number("width_um", groove.width_um, positive(1e5), "at half the depth");
  fields.number("depth_um", groove.depth_um, positive(1e4), "along z");
  fields.number("wall_angle_deg", groove.wall_angle_deg, {1.0, 90.0}, "of the walls against the land");
  fields.number("direction_deg", groove.direction_deg, kDirection, "of the groove, 90: down the image");
}

void describe(Stairs& stairs, Fields& fields) {
  fields.list("treads", stairs.treads, {2, 64}, "side by side across the direction; the outer ones reach to the border",
              [](Fields& inner, Tread& tread) {
                inner.number("width_um", tread.width_um, positive(1e5), "across");
                inner.number("height_um", tread.height_um, {-1e4, 1e4}, "over base_um");
              });
  fields.number("direction_deg", stairs.direction_deg, kDirection, "of the edges, 90: down the image");
}

void describe(Sinusoid& sinusoid, Fields& fields) {
  fields.number("amplitude_um", sinusoid.amplitude_um, positive(1e4), "half of peak to valley");
  fields.number("wavelength_um", sinusoid.wavelength_um, positive(1e5), "across the crests");
  fields.number("phase_deg", sinusoid.phase_deg, {-360.0, 360.0}, "in the image's middle");
  fields.number("direction_deg", sinusoid.direction_deg, kDirection, "of the crests, 90: down the image");
}

void describe(Star& star, Fields& fields) {
  fields.integer("pairs", star.pairs, {2, 720}, "of a raised sector and one that is not");
  fields.number("height_um", star.height_um, positive(1e4), "of the raised ones");
  fields.number("radius_um", star.radius_um, positive(1e5), "of the star");
  fields.number("direction_deg", star.direction_deg, kDirection, "of the middle of a raised sector");
}

void describe(CrossGrid& grid, Fields& fields) {
  fields.number("pitch_x_um", grid.pitch_x_um, positive(1e5), "from crossing to crossing along the first axis");
  fields.number("pitch_y_um", grid.pitch_y_um, positive(1e5), "along the second axis");
  fields.number("angle_deg", grid.angle_deg, {30.0, 150.0}, "from the first axis to the second");
  fields.number("direction_deg", grid.direction_deg, kDirection, "of the first axis");
  fields.number("line_width_um", grid.line_width_um, positive(1e5), "along the axis that crosses the line");
  fields.number("height_um", grid.height_um, positive(1e4), "of the lines");
}

void describe(LetterF& letter, Fields& fields) {
  fields.number("size_um", letter.size_um, positive(1e5), "height of the letter in the image");
  fields.number("height_um", letter.height_um, positive(1e4), "over the land");
}

void describe_rounding(CuttingEdge& edge, Fields& fields) {
  static const std::vector<std::string> kNames{"sharp", "circle", "conic"};
  std::string kind = kNames[static_cast<std::size_t>(edge.rounding)];
  const Shape sharp{"sharp", [](Fields&) {}};
  const Shape circle{"circle",
                     [&](Fields& inner) { inner.number("radius_um", edge.radius_um, positive(1e4), "of the circle"); }};
  const Shape conic{"conic", [&](Fields& inner) {
                      inner.number("S_gamma_um", edge.s_gamma_um, positive(1e4), "from apex to end of the rake");
                      inner.number("S_alpha_um", edge.s_alpha_um, positive(1e4), "from apex to end of the clearance");
                      inner.optional("weight", edge.weight, [](Fields& of, double& weight) {
                        of.number("weight", weight, {0.01, 100.0}, "of the apex; without one sin(beta / 2)");
                      });
                    }};
  fields.variant("kind", kind, {sharp, circle, conic}, "between the flanks");
  edge.rounding = static_cast<Rounding>(std::find(kNames.begin(), kNames.end(), kind) - kNames.begin());
}

void describe(CuttingEdge& edge, Fields& fields) {
  fields.number("direction_deg", edge.direction_deg, kDirection,
                "of the edge, 90: down the image with the rake on the left, 0: along x with the rake below");
  fields.number("beta_deg", edge.beta_deg, {20.0, 170.0}, "wedge angle");
  fields.group("rounding", "between the flanks", [&](Fields& inner) { describe_rounding(edge, inner); });
  fields.list("notches", edge.notches, {0, 64}, "chips out of the edge", [](Fields& inner, Notch& notch) {
    inner.number("position_um", notch.position_um, kPlace_um, "along the edge from the image's middle");
    inner.number("width_um", notch.width_um, positive(1e4), "at half the depth");
    inner.number("depth_um", notch.depth_um, positive(1e3), "towards the least distance from apex to contour");
  });
  fields.optional("bend_radius_um", edge.bend_radius_um, [](Fields& inner, double& radius) {
    inner.number("bend_radius_um", radius, kPlace_um,
                 "of the edge's arc; positive: its centre on the clearance's side");
  });
}

}  // namespace

void describe_artefact(WorldParameters& world, Fields& fields) {
  Artefacts& artefacts = world.artefacts;
  const SurfaceKind kind = world.surface;
  const auto own = [&](SurfaceKind of, const char* name, const char* meaning, auto& artefact) {
    if (kind != of) return;
    fields.group(name, meaning, [&](Fields& inner) { describe(artefact, inner); });
  };
  own(SurfaceKind::kGroove, "groove", "a flat-bottomed groove", artefacts.groove);
  own(SurfaceKind::kStairs, "stairs", "levels side by side", artefacts.stairs);
  own(SurfaceKind::kSinusoid, "sinusoid", "a sinusoid", artefacts.sinusoid);
  own(SurfaceKind::kStar, "star", "a Siemens star", artefacts.star);
  own(SurfaceKind::kCrossGrid, "cross_grid", "raised lines in two directions", artefacts.cross_grid);
  own(SurfaceKind::kLetterF, "letter_f", "a raised letter", artefacts.letter_f);
  own(SurfaceKind::kEdge, "edge", "a cutting edge", artefacts.edge);
  if (kind == SurfaceKind::kChapter || kind == SurfaceKind::kLayered) return;
  fields.group("contrast_map", "where the surface is polished",
               [&](Fields& inner) { describe(artefacts.contrast, inner); });
  if (kind == SurfaceKind::kTilted) return;
  fields.group("tilt", "of the plane it lies on", [&](Fields& inner) { describe(artefacts.tilt, inner); });
}

}  // namespace fvd::sim
