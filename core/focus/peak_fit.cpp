#include "core/focus/peak_fit.hpp"

#include <algorithm>
#include <cmath>

namespace fvd {

namespace {

double transformed(PeakMethod method, std::uint32_t value) {
  const auto sharpness = static_cast<double>(value);
  if (method == PeakMethod::kLogParabola) return std::log(std::max(sharpness, 0.5));
  if (method == PeakMethod::kInverseRoot) return -1.0 / std::sqrt(std::max(sharpness, 0.5));  // rising, as the others
  return sharpness;
}

}  // namespace

std::optional<double> fit_peak_um(PeakMethod method, const PeakTriple& triple) noexcept {
  const double d1 = triple.z_left_um - triple.z_peak_um;
  const double d3 = triple.z_right_um - triple.z_peak_um;
  const bool one_way = (d1 < 0 && d3 > 0) || (d1 > 0 && d3 < 0);
  const bool encloses = triple.left <= triple.peak && triple.right <= triple.peak &&
                        (triple.left < triple.peak || triple.right < triple.peak);
  if (!one_way || !encloses) return std::nullopt;
  if (method == PeakMethod::kNearest) return triple.z_peak_um;
  const double top = transformed(method, triple.peak);
  const double a = transformed(method, triple.left) - top;
  const double b = transformed(method, triple.right) - top;
  // a, b <= 0 and not both 0 in exact arithmetic; a logarithm or root may round a difference of one count away.
  const double total = a * d3 - b * d1;
  if (total == 0.0) return triple.z_peak_um;
  const double weight = a * d3 / total;
  return triple.z_peak_um + 0.5 * (weight * d3 + (1.0 - weight) * d1);
}

}  // namespace fvd
