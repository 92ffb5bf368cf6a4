#pragma once

/// Gaussian filters of profiles with holes: mean, local line, local parabola; each also robust.

#include <span>
#include <vector>

#include "core/metrology/filter/filter_settings.hpp"

namespace fvd::metrology {

struct FilteredProfile {
  std::vector<double> z_um;  ///< as many as went in; NaN = hole
  FilterReport report;
};

/// Smooth profile (S) or profile minus smooth profile (L), by ISO 16610-21 and -31 (see FilterMethod). z_um: equally
/// spaced, NaN = hole. Rules for holes, borders and robust rounds are those of filter_surface().
///
/// Throws Error(kBadInput) where nesting_um is under kMinNestingPx points, not a number, or the profile is empty.
/// context: pure. Cost: points times reach.
[[nodiscard]] FilteredProfile filter_profile(std::span<const double> z_um, double pitch_um,
                                             const FilterSettings& settings);

}  // namespace fvd::metrology
