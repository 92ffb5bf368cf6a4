#include "core/focus/confocal_width.hpp"

#include <cmath>
#include <string>

#include "core/base/error.hpp"

namespace fvd {

double confocal_width_um(double na, double wavelength_um, double index) {
  constexpr double kHalfOfSincSquared = 0.442946;  // 1.391557 / pi
  if (!(wavelength_um > 0.0) || !(index >= 1.0) || !std::isfinite(wavelength_um) || !std::isfinite(index)) {
    throw Error(ErrorCode::kBadInput, "a wavelength of " + std::to_string(1e3 * wavelength_um) +
                                          " nm and an index of " + std::to_string(index) +
                                          ": must be above 0 and at least 1");
  }
  if (!(na > 0.0 && na < index)) {
    throw Error(ErrorCode::kBadInput, "a numerical aperture of " + std::to_string(na) +
                                          ": must be above 0 and below the refractive index, " + std::to_string(index));
  }
  return kHalfOfSincSquared * wavelength_um / (index - std::sqrt(index * index - na * na));
}

}  // namespace fvd
