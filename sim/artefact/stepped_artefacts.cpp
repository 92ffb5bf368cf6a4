#include "sim/artefact/stepped_artefacts.hpp"

#include <algorithm>
#include <cmath>

namespace fvd::sim {

double wall_run_um(const Groove& groove) {
  return groove.wall_angle_deg >= 90.0 ? 0.0 : groove.depth_um / std::tan(radians(groove.wall_angle_deg));
}

Level level_at(const Groove& groove, const Place& place) {
  const double out = std::abs(Directed(groove.direction_deg).across(place)) - 0.5 * groove.width_um;
  const double half_run = 0.5 * wall_run_um(groove);
  if (out >= half_run) return {0.0, 0};
  if (out < -half_run || half_run == 0.0) return {-groove.depth_um, 1};
  return {groove.depth_um * (out - half_run) / (2.0 * half_run), kWall};
}

Level level_at(const Stairs& stairs, const Place& place) {
  double edge = 0.0;
  for (const Tread& tread : stairs.treads) edge -= 0.5 * tread.width_um;
  const double across = Directed(stairs.direction_deg).across(place);
  std::size_t at = 0;
  for (; at + 1 < stairs.treads.size(); ++at) {
    edge += stairs.treads[at].width_um;
    if (across < edge) break;
  }
  return {stairs.treads[at].height_um, static_cast<std::uint8_t>(at)};
}

Level level_at(const Star& star, const Place& place) {
  if (std::hypot(place.x_um, place.y_um) > star.radius_um) return {0.0, 0};
  const double angle = std::atan2(place.y_um, place.x_um) - radians(star.direction_deg);
  const bool raised = std::cos(star.pairs * angle) > 0.0;
  return raised ? Level{star.height_um, 1} : Level{0.0, 0};
}

/// place = u axis1 + v axis2; a line along the second axis is where u is near a multiple of the first pitch.
Level level_at(const CrossGrid& grid, const Place& place) {
  const Directed first(grid.direction_deg);
  const double angle = radians(grid.angle_deg);
  const double v = -first.across(place) / std::sin(angle);  // the second axis is turned from x towards y
  const double u = first.along(place) - v * std::cos(angle);
  const auto on_line = [&](double coordinate, double pitch) {
    return std::abs(coordinate - pitch * std::round(coordinate / pitch)) < 0.5 * grid.line_width_um;
  };
  const bool raised = on_line(u, grid.pitch_x_um) || on_line(v, grid.pitch_y_um);
  return raised ? Level{grid.height_um, 1} : Level{0.0, 0};
}

std::array<Stroke, 3> strokes(const LetterF& letter) {
  const double stroke = letter.size_um / 5.0;
  const double left = -1.5 * stroke;
  const double top = -2.5 * stroke;
  return {{{left, top, stroke, 5.0 * stroke},
           {left, top, 3.0 * stroke, stroke},
           {left, top + 2.0 * stroke, 2.0 * stroke, stroke}}};
}

Level level_at(const LetterF& letter, const Place& place) {
  const auto all = strokes(letter);
  const bool raised = std::any_of(all.begin(), all.end(), [&](const Stroke& s) {
    return place.x_um >= s.x_um && place.x_um < s.x_um + s.width_um && place.y_um >= s.y_um &&
           place.y_um < s.y_um + s.height_um;
  });
  return raised ? Level{letter.height_um, 1} : Level{0.0, 0};
}

Level level_at(const Sinusoid& sinusoid, const Place& place) {
  const double turns = Directed(sinusoid.direction_deg).across(place) / sinusoid.wavelength_um;
  return {sinusoid.amplitude_um * std::sin(2.0 * std::numbers::pi * turns + radians(sinusoid.phase_deg)), 0};
}

}  // namespace fvd::sim
