#include "core/metrology/profile/profile_material_ratio.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <vector>

namespace fvd::metrology {
namespace {

constexpr double kSecant = 0.4;
constexpr double kEqual = 1e-9;

/// Height over material ratio, see the header.
class Curve {
 public:
  explicit Curve(std::span<const double> sorted_um) : z_(sorted_um) {}

  [[nodiscard]] double count() const { return static_cast<double>(z_.size()); }

  /// Beyond the first and the last point it goes on straight: level ends would make secants there too flat by half a
  /// point.
  [[nodiscard]] double height(double ratio) const {
    const double place = ratio * count() - 0.5;
    const auto i = static_cast<std::size_t>(std::clamp(place, 0.0, count() - 2.0));
    const double share = place - static_cast<double>(i);
    return (1.0 - share) * z_[i] + share * z_[i + 1];
  }

  /// Where the curve falls through a height: the smallest ratio at which it is not above; 0 or 1 where it never is or
  /// always.
  [[nodiscard]] double ratio(double height_um) const {
    if (z_.front() <= height_um) return 0.0;
    const auto below = std::partition_point(z_.begin(), z_.end(), [&](double z) { return z > height_um; });
    if (below == z_.end()) return 1.0;
    const auto i = static_cast<double>(below - z_.begin());
    const double above_um = *(below - 1);
    return (i - 0.5 + (above_um - height_um) / (above_um - *below)) / count();
  }

  /// Area between the curve and a height where the curve is above it.
  [[nodiscard]] double area_above(double height_um) const {
    return area([&](double z) { return z - height_um; });
  }
  [[nodiscard]] double area_below(double height_um) const {
    return area([&](double z) { return height_um - z; });
  }

 private:
  /// Area where the excess is positive: half a step level at both ends, trapezoids and triangles between.
  template <typename Excess>
  [[nodiscard]] double area(const Excess& excess) const {
    double sum = 0.5 * (std::max(excess(z_.front()), 0.0) + std::max(excess(z_.back()), 0.0));
    for (std::size_t i = 0; i + 1 < z_.size(); ++i) {
      const double a = excess(z_[i]);
      const double b = excess(z_[i + 1]);
      if (a >= 0.0 && b >= 0.0) {
        sum += 0.5 * (a + b);
      } else if (a > 0.0 || b > 0.0) {
        const double top = std::max(a, b);
        sum += 0.5 * top * top / (top - std::min(a, b));
      }
    }
    return sum / count();
  }

  std::span<const double> z_;
};

struct Secant {
  double from = 0.0;
  double fall_um = 0.0;
  bool tie = false;
};

/// The fall over 40 % is straight between places where either end meets a corner of the curve.
Secant flattest_secant(const Curve& curve, double range_um) {
  constexpr double kLast = 1.0 - kSecant;
  std::vector<double> places{0.0, kLast};
  const auto count = static_cast<std::size_t>(curve.count());
  for (std::size_t i = 0; i < count; ++i) {
    const double corner = (static_cast<double>(i) + 0.5) / curve.count();
    if (corner < kLast) places.push_back(corner);
    if (corner > kSecant) places.push_back(corner - kSecant);
  }
  std::sort(places.begin(), places.end());
  const auto fall_at = [&](double from) { return curve.height(from) - curve.height(from + kSecant); };
  double least = fall_at(0.0);
  for (const double from : places) least = std::min(least, fall_at(from));
  Secant secant;
  bool found = false;
  bool left_it = false;
  for (const double from : places) {
    const double fall = fall_at(from);
    const bool equal = fall <= least + kEqual * range_um;
    if (equal && !found) secant = {from, fall, false};
    if (found && !equal) left_it = true;
    // Neighbouring places of one flat stretch are no second secant.
    if (equal && left_it) secant.tie = true;
    found = found || equal;
  }
  return secant;
}

}  // namespace

MaterialRatioCore material_ratio_core(std::span<const double> sorted_um) {
  assert(sorted_um.size() >= 3 && std::is_sorted(sorted_um.rbegin(), sorted_um.rend()));
  const Curve curve(sorted_um);
  const double range_um = sorted_um.front() - sorted_um.back();
  const Secant secant = flattest_secant(curve, range_um);
  const double slope = secant.fall_um / kSecant;
  const double upper_um = curve.height(secant.from) + slope * secant.from;
  const double lower_um = upper_um - slope;
  MaterialRatioCore core;
  core.core_um = upper_um - lower_um;
  core.tie = secant.tie;
  const double upper = curve.ratio(upper_um);
  const double lower = curve.ratio(lower_um);
  core.upper_percent = 100.0 * upper;
  core.lower_percent = 100.0 * lower;
  // Triangles of the same area over the same ratio.
  core.peaks_um = upper > 0.0 ? 2.0 * curve.area_above(upper_um) / upper : 0.0;
  core.valleys_um = lower < 1.0 ? 2.0 * curve.area_below(lower_um) / (1.0 - lower) : 0.0;
  return core;
}

}  // namespace fvd::metrology
