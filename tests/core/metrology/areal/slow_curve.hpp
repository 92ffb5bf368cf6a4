#pragma once

/// The material ratio curve again, in long double and by another algorithm.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace fvd::metrology {

/// The curve and its figures, by searching and clipping instead of by sweeping. Equal heights are one knot; level
/// stretches are not for it.
class SlowCurve {
 public:
  explicit SlowCurve(const std::vector<double>& descending) {
    const auto count = static_cast<long double>(descending.size());
    const long double same = 1e-12L * (descending.front() - descending.back());
    for (std::size_t i = 0, end = 0; i < descending.size(); i = end) {
      long double sum = 0.0L;
      for (end = i; end < descending.size() && descending[i] - descending[end] <= same; ++end) sum += descending[end];
      const auto run = static_cast<long double>(end - i);
      knots_.emplace_back((static_cast<long double>(i) + run / 2.0L) / count, sum / run);
    }
  }
  [[nodiscard]] long double at(long double p) const {
    if (p <= knots_.front().first) return knots_.front().second;
    if (p >= knots_.back().first) return knots_.back().second;
    return beyond(p);
  }
  /// Straight on at the ends.
  [[nodiscard]] long double beyond(long double p) const {
    std::size_t i = 0;
    while (i + 2 < knots_.size() && knots_[i + 1].first < p) ++i;
    const auto [p0, z0] = knots_[i];
    const auto [p1, z1] = knots_[i + 1];
    return z0 + (z1 - z0) * (p - p0) / (p1 - p0);
  }
  /// The smallest drop over 40 % and where it begins.
  [[nodiscard]] std::pair<long double, long double> smallest_drop() const {
    std::vector<long double> begins = {0.0L, 0.6L};
    for (const auto& [p, z] : knots_) {
      if (p <= 0.6L) begins.push_back(p);
      if (p >= 0.4L) begins.push_back(p - 0.4L);
    }
    const auto drop = [&](long double begin) { return beyond(begin) - beyond(begin + 0.4L); };
    long double least = drop(0.0L);
    for (const long double begin : begins) least = std::min(least, drop(begin));
    // Of those that are equal but for rounding, the first.
    const long double same = least + 1e-12L * (knots_.front().second - knots_.back().second);
    std::sort(begins.begin(), begins.end());
    const auto first =
        std::find_if(begins.begin(), begins.end(), [&](long double begin) { return drop(begin) <= same; });
    return {drop(*first), *first};
  }
  /// The area between the curve and a height, where sign * (curve - height) is positive, cut at every crossing.
  [[nodiscard]] long double area(long double height, long double sign) const {
    long double area = 0.0L;
    std::vector<std::pair<long double, long double>> points = knots_;
    points.insert(points.begin(), {0.0L, knots_.front().second});
    points.emplace_back(1.0L, knots_.back().second);
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
      const long double a = sign * (points[i].second - height);
      const long double b = sign * (points[i + 1].second - height);
      const long double width = points[i + 1].first - points[i].first;
      if (a >= 0.0L && b >= 0.0L) area += width * (a + b) / 2.0L;
      if (a * b < 0.0L) area += width * std::max(a, b) / 2.0L * std::max(a, b) / (std::max(a, b) - std::min(a, b));
    }
    return area;
  }
  [[nodiscard]] long double ratio_of(long double height) const {
    long double low = 0.0L;
    long double high = 1.0L;
    for (int i = 0; i < 100; ++i) (at((low + high) / 2.0L) >= height ? low : high) = (low + high) / 2.0L;
    return low;
  }

 private:
  std::vector<std::pair<long double, long double>> knots_;
};

}  // namespace fvd::metrology
