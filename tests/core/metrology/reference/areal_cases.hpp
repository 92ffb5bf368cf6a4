#pragma once

/// Areal figures of sampled surfaces in long double, for the reference cases.

#include <vector>

#include "tests/core/metrology/areal/areal_surfaces.hpp"
#include "tests/core/metrology/areal/slow_curve.hpp"
#include "tests/core/metrology/reference/reference_case.hpp"

namespace fvd::metrology::reference {

struct Moments {
  long double sa = 0.0L;
  long double sq = 0.0L;
  long double ssk = 0.0L;
  long double sku = 0.0L;
  long double sz = 0.0L;
};
[[nodiscard]] Moments moments_of(const std::vector<long double>& heights_um);

/// Sk and what belongs to it, volumes and Sxp.
struct Material {
  long double sk, spk, svk, smr1, smr2, vmp, vmc, vvc, vvv, sxp;
};
[[nodiscard]] Material material_of(const std::vector<long double>& heights_um);

/// What central differences make of d sin(k x) / dx = k cos(k x), over k: order 2, 4 or 6, phase = k times the pitch.
[[nodiscard]] long double difference_gain(int order, long double phase);

/// The order of the highest central difference that fits between both borders; 0 = none.
[[nodiscard]] int order_at(int point, int count);

/// The autocorrelation of a line's points at every lag, over its own mean square.
[[nodiscard]] std::vector<long double> autocorrelation_of(const std::vector<long double>& heights_um, int lags);

/// The cubic through the four lags around a place.
[[nodiscard]] long double between_lags(const std::vector<long double>& correlation, long double lag);

}  // namespace fvd::metrology::reference
