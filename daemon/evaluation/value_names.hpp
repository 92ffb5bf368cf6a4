#pragma once

/// The names of the values that each kind of measurement gives, with their units as suffix.

#include <string>
#include <vector>

#include "daemon/evaluation/evaluation_plan.hpp"

namespace fvd {

/// Parameters that a recipe can ask for, without units: "Sa", "Sdr", ...
[[nodiscard]] std::vector<std::string> areal_value_names();
[[nodiscard]] std::vector<std::string> profile_value_names();

/// "Sa_um" of "Sa"; the name itself where the value has no unit or the name is not known.
[[nodiscard]] std::string areal_value_key(const std::string& name);
[[nodiscard]] std::string profile_value_key(const std::string& name);

/// Every value of the measurement, e.g. {"height_um", "height_areal_um", ...}; limits are keyed by these.
[[nodiscard]] std::vector<std::string> value_keys(const PlannedMeasurement& measurement);

/// The value of a height of region `upper` over region `lower`, among the levels.
[[nodiscard]] std::string level_value_key(const std::string& upper, const std::string& lower);

/// By which powers a value grows with the lengths that it is made of.
struct ValuePowers {
  double z = 0.0;   ///< of heights along the axis
  double xy = 0.0;  ///< of lengths in the image
  bool operator==(const ValuePowers&) const = default;
};

/// Of a value of this kind of measurement, own definition: 1, 0 of heights, steps, levels and every texture parameter
/// in um but Sal and RSm, which are lengths in the image: 0, 1, as are the groove's width and radii and lengths of
/// cutting edges. Gradients Sdq and Rdq: 1, -1. Sdr: 2, -2, its limit for small slopes, which steep ones stay below.
/// The radius of a groove's bottom: -1, 2. Shapes, shares, angles, counts and the edge line: 0, 0.
[[nodiscard]] ValuePowers value_powers(const std::string& kind, const std::string& key);

/// "um" of "radius_um", "deg" of "beta_deg", "%" of "Smr1_percent", "1" of "K".
[[nodiscard]] std::string unit_of_key(const std::string& key);

}  // namespace fvd
