#include "core/focus/fit/peak_fit.hpp"

#include <algorithm>
#include <cmath>

namespace fvd {

namespace {

/// g of a sample and what its noise makes of g.
struct Transformed {
  double value = 0.0;
  double slope = 0.0;
};

Transformed transformed(PeakMethod method, double sharpness, double smallest) {
  const double floored = std::max(sharpness, smallest);
  if (method == PeakMethod::kLogParabola) return {std::log(floored), 1.0 / floored};
  if (method == PeakMethod::kInverseRoot) {  // rising, as the others
    const double root = 1.0 / std::sqrt(floored);
    return {-root, 0.5 * root / floored};
  }
  return {sharpness, 1.0};
}

}  // namespace

std::optional<PeakPosition> fit_peak(PeakMethod method, const PeakTriple& triple, double smallest) noexcept {
  const double d1 = triple.z_left_um - triple.z_peak_um;
  const double d3 = triple.z_right_um - triple.z_peak_um;
  const bool one_way = (d1 < 0 && d3 > 0) || (d1 > 0 && d3 < 0);
  const bool encloses = triple.left <= triple.peak && triple.right <= triple.peak &&
                        (triple.left < triple.peak || triple.right < triple.peak);
  if (!one_way || !encloses) return std::nullopt;
  const double step = (std::abs(d1) + std::abs(d3)) / 2;
  if (method == PeakMethod::kNearest) return PeakPosition{triple.z_peak_um, step / std::sqrt(12.0)};
  const Transformed top = transformed(method, triple.peak, smallest);
  const Transformed left = transformed(method, triple.left, smallest);
  const Transformed right = transformed(method, triple.right, smallest);
  const double a = left.value - top.value;
  const double b = right.value - top.value;
  // a, b <= 0 and not both 0 in exact arithmetic; a logarithm or root may round a small difference away.
  const double total = a * d3 - b * d1;
  if (total == 0.0) return PeakPosition{triple.z_peak_um, step / std::sqrt(12.0)};
  const double weight = a * d3 / total;
  const double offset = 0.5 * (weight * d3 + (1.0 - weight) * d1);
  const double by_a = d3 * (0.5 * d3 - offset) / total;
  const double by_b = -d1 * (0.5 * d1 - offset) / total;
  const double variance =
      std::pow(by_a * left.slope, 2) + std::pow(by_b * right.slope, 2) + std::pow((by_a + by_b) * top.slope, 2);
  return PeakPosition{triple.z_peak_um + offset, triple.noise * std::sqrt(variance)};
}

}  // namespace fvd
