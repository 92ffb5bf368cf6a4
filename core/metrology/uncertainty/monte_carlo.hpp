#pragma once

/// Uncertainty of values that are not linear in the heights, by adding the noise of further scans to the field.

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "core/metrology/height_field.hpp"
#include "core/runtime/worker_pool.hpp"

namespace fvd::metrology {

/// The values of a field; absent where one cannot be given. Always the same number of values. The region is empty
/// (every point) where the caller gave none.
using ValuesOfField = std::function<std::vector<std::optional<double>>(const HeightField& field, const Region& region)>;

struct MonteCarloSettings {
  int draws = 200;         ///< 2 or more
  std::uint64_t seed = 1;  ///< belongs into the result
  /// The field is cut to the rectangle of the region and so much around it; what the values need of the surroundings
  /// (filters, central differences), in pixels. Negative = nothing is cut.
  int margin_px = 0;
};

struct MonteCarloValue {
  std::optional<double> u;     ///< standard deviation over the draws; absent where under 9 of 10 draws have a value
  std::optional<double> mean;  ///< over the draws; less the undisturbed value it is the bias that noise adds
  int draws = 0;               ///< that gave a value
};

struct MonteCarlo {
  std::vector<MonteCarloValue> values;  ///< in the order of the function
  std::uint64_t seed = 0;
  int draws = 0;
};

/// JCGM 101:2008, with errors of the form of linear_noise(). Absent where the field has no sigma or the region no
/// point. context: calls `values` `draws` times, on the caller's thread; with a pool on several at once, and the result
/// is the same.
[[nodiscard]] std::optional<MonteCarlo> monte_carlo(const HeightField& field, const Region& region,
                                                    const MonteCarloSettings& settings, const ValuesOfField& values,
                                                    WorkerPool* pool = nullptr);

}  // namespace fvd::metrology
