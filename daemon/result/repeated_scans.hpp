#pragma once

/// What several scans of one part say of each other.

#include <optional>

#include "core/image/image.hpp"

namespace fvd {

struct RepeatedScans {
  int scans = 0;                    ///< >= 2
  Plane<float> sd_m;                ///< standard deviation of the scans at each point, metres; NaN in holes
  std::optional<double> sd_rms_um;  ///< root mean square of it over the valid points; absent without a valid point
};

}  // namespace fvd
