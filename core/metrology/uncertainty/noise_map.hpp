#pragma once

/// Draws of the noise of a height map: white noise averaged by the window's kernel, scaled by sigma.

#include <cstdint>

#include "core/metrology/height_field.hpp"

namespace fvd::metrology {

/// The errors that a further scan might have shown. context: one thread an object; the field outlives it.
class NoiseMaps {
 public:
  /// The field must have sigma. Throws Error(kBadInput) if it has not.
  NoiseMaps(const HeightField& field, std::uint64_t seed);

  /// Writes the field's heights plus the noise of draw number `draw` to z_um, of the shape of the field; holes stay.
  /// The same draw gives the same bytes, whatever was drawn before.
  void add_to_heights(std::uint64_t draw, Plane<double>& z_um);

 private:
  const HeightField& field_;
  std::uint64_t seed_;
  Plane<double> white_;    // of the field's size plus the kernel's reach on every side
  Plane<double> columns_;  // averaged along x
};

}  // namespace fvd::metrology
