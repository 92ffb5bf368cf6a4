#pragma once

/// Constants with every member set to a value of its own.

#include "daemon/result/calibration.hpp"

namespace fvd::test {

inline ConstantsOrigin origin_of(const std::string& name) {
  return {"study-" + name, "Ada of " + name, "PTB-" + name, "2026-11-29T20:15:00Z", "2027-11-29", true};
}

inline Calibration whole_calibration() {
  Calibration calibration;
  calibration.id = "cal-0003";
  calibration.objective = "10x";
  calibration.created = "2026-11-29T20:15:01Z";
  calibration.z = ZConstants{1.0021, 0.0003, 0.04, 0.02, 500.0, origin_of("z")};
  calibration.flatness = FlatnessConstants{0.12, 0.004, "cal-0003-flatness.gsf", origin_of("flatness")};
  calibration.noise = NoiseConstants{0.05, origin_of("noise")};
  calibration.lateral = LateralConstants{0.501, 0.502, 1e-4, 2e-4, -3e-4, 0.08, 1e-3, -2e-3, origin_of("lateral")};
  calibration.texture = TextureConstants{2.5, origin_of("texture")};
  return calibration;
}

}  // namespace fvd::test
