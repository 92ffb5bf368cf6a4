#pragma once

/// The values of a result, one by one, as the job database keeps them.

#include <vector>

#include "daemon/result/result.hpp"
#include "daemon/store/stored_value.hpp"

namespace fvd {

/// The measurement that stands for the height map as a whole, with or without a recipe's evaluation.
inline constexpr const char* kMapMeasurement = "map";

/// Those of the evaluation in the recipe's order, then those of the map as a whole, unless the recipe calls a
/// measurement of its own so. A measurement that failed as a whole has its main value, which is absent.
/// context: pure.
[[nodiscard]] std::vector<StoredValue> values_of(const Result& result);

}  // namespace fvd
