#pragma once

/// One value of a job's result, as run charts draw it.

#include <optional>
#include <string>

namespace fvd {

/// All numbers in the unit of the value, which the result tells.
struct StoredValue {
  std::string measurement;           ///< of the recipe; "map" = of the height map as a whole
  std::string name;                  ///< of the value, with its unit: "height_um"
  std::optional<double> value;       ///< absent = it could not be given
  std::optional<double> u;           ///< standard uncertainty; absent = not known
  std::optional<double> expanded_u;  ///< U = k u; absent = not known
  std::optional<double> lower;       ///< limits; absent = none
  std::optional<double> upper;
  std::string verdict;  ///< pass, fail, uncertain, invalid; empty = nothing was judged
  bool operator==(const StoredValue&) const = default;
};

}  // namespace fvd
