#pragma once

/// Heights along a line across a stored result, as an evaluation of it takes them.

#include <vector>

#include "core/metrology/profile/profile.hpp"
#include "daemon/result/result.hpp"
#include "daemon/views/result_maps.hpp"

namespace fvd {

/// One element a point, NaN = hole.
struct LineProfile {
  std::vector<double> distance_um;  ///< from the line's start
  std::vector<double> height_um;
  std::vector<double> sigma_um;  ///< standard error of a single point, mean over the band; NaN also where not known
};

/// metrology::extract_profile() of the surface "measured", bit for bit, read from the folder in small pieces. result:
/// as result.json of the folder tells it. Throws Error kRegionOutside where line or band leave the map, kBadInput where
/// the line is too short or no line, or line and band have more than 2,000,000 samples, kSurfaceFile where the maps
/// cannot be read or the result tells no pitch. context: thread-safe.
[[nodiscard]] LineProfile line_profile(ResultMaps& maps, const Result& result, const metrology::ProfileLine& line);

}  // namespace fvd
