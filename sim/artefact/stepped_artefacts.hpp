#pragma once

/// Heights of artefacts made of levels with walls between, and of the sinusoid, before any tilt.

#include <array>
#include <cstdint>

#include "sim/artefact/plan.hpp"

namespace fvd::sim {

/// What lies at a place.
struct Level {
  double height_um = 0.0;
  std::uint8_t level = 0;  ///< which of the artefact's levels, or kWall
};
inline constexpr std::uint8_t kWall = 255;

[[nodiscard]] Level level_at(const Groove& groove, const Place& place);
[[nodiscard]] Level level_at(const Stairs& stairs, const Place& place);
[[nodiscard]] Level level_at(const Star& star, const Place& place);
[[nodiscard]] Level level_at(const CrossGrid& grid, const Place& place);
[[nodiscard]] Level level_at(const LetterF& letter, const Place& place);
[[nodiscard]] Level level_at(const Sinusoid& sinusoid, const Place& place);

/// From the foot of a wall to its top, in the image; 0 if it is vertical.
[[nodiscard]] double wall_run_um(const Groove& groove);

/// A rectangle in the image, its upper left corner.
struct Stroke {
  double x_um = 0.0;
  double y_um = 0.0;
  double width_um = 0.0;
  double height_um = 0.0;
};
/// Stem, upper arm, middle arm.
[[nodiscard]] std::array<Stroke, 3> strokes(const LetterF& letter);

}  // namespace fvd::sim
