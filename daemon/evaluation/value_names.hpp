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

/// "um" of "radius_um", "deg" of "beta_deg", "%" of "Smr1_percent", "1" of "K".
[[nodiscard]] std::string unit_of_key(const std::string& key);

}  // namespace fvd
