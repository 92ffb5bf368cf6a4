#pragma once

/// Percentiles of a sample.

#include <vector>

namespace fvd {

/// The value below which the fraction p in [0, 1] of the sample lies, interpolated linearly between the order
/// statistics (definition 7 of Hyndman and Fan, "Sample quantiles in statistical packages", The American Statistician
/// 50, 1996). values: at least one, finite, any order. context: pure.
[[nodiscard]] double quantile(std::vector<double> values, double p);

}  // namespace fvd
