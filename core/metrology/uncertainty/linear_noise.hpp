#pragma once

/// The noise of means, steps, planes and all other linear estimates, with the correlation of neighbouring points.

#include <optional>
#include <span>
#include <vector>

#include "core/metrology/height_field.hpp"
#include "core/metrology/uncertainty/weight_map.hpp"
#include "core/runtime/worker_pool.hpp"

namespace fvd::metrology {

struct LinearNoise {
  double u = 0.0;              ///< standard deviation of the estimate, in its unit; >= 0
  double points_as_one = 1.0;  ///< variance over that of independent points: so many neighbours count as one
};

/// Errors of points are white noise averaged by the field's kernel k, of the standard deviations in sigma_um:
///   var(sum w_i z_i) = sum over p of (sum over i of k(p - i) w_i sigma_i)^2 / sum of k^2.
/// p reaches beyond the field by the kernel's reach. Absent where the field has no sigma. Every point with a weight
/// must have a sigma. Own definition (GUM 5.2.2 with the correlation of the focus window). context: pure, as the next.
/// Cost: one separable convolution of the map's rectangle, in bands where a pool is given; the same bytes either way.
[[nodiscard]] std::optional<LinearNoise> linear_noise(const HeightField& field, const WeightMap& map,
                                                      WorkerPool* pool = nullptr);

/// Covariances of several estimates under the same noise: row-major, maps.size() squared, symmetric. At least one map.
[[nodiscard]] std::optional<std::vector<double>> linear_covariance(const HeightField& field,
                                                                   std::span<const WeightMap* const> maps);

/// Gives every point that is not a hole the same standard error, e.g. for a file that comes without.
/// sigma_um > 0 and finite.
void set_uniform_sigma(HeightField& field, double sigma_um);

}  // namespace fvd::metrology
