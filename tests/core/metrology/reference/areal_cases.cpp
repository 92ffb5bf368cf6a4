#include "tests/core/metrology/reference/areal_cases.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>

namespace fvd::metrology::reference {

Moments moments_of(const std::vector<long double>& heights_um) {
  const auto count = static_cast<long double>(heights_um.size());
  long double mean = 0.0L;
  for (const long double z : heights_um) mean += z / count;
  Moments made;
  long double cubes = 0.0L;
  long double fourths = 0.0L;
  long double squares = 0.0L;
  for (const long double z : heights_um) {
    const long double d = z - mean;
    made.sa += std::abs(d) / count;
    squares += d * d / count;
    cubes += d * d * d / count;
    fourths += d * d * d * d / count;
  }
  made.sq = std::sqrt(squares);
  made.ssk = cubes / (squares * made.sq);
  made.sku = fourths / (squares * squares);
  const auto [low, high] = std::minmax_element(heights_um.begin(), heights_um.end());
  made.sz = *high - *low;
  return made;
}

Material material_of(const std::vector<long double>& heights_um) {
  std::vector<double> descending(heights_um.begin(), heights_um.end());
  std::sort(descending.begin(), descending.end(), std::greater<>());
  const SlowCurve curve(descending);
  const auto [drop, begin] = curve.smallest_drop();
  const long double slope = drop / 0.4L;
  const long double top = curve.beyond(begin) + slope * begin;
  // A line that ends at the curve's ends cuts no triangle off.
  const long double ratio1 = top >= descending.front() ? 0.0L : curve.ratio_of(top);
  const long double ratio2 = top - slope <= descending.back() ? 1.0L : curve.ratio_of(top - slope);
  const auto material = [&](long double p) { return curve.area(curve.at(p), 1.0L); };
  const auto voids = [&](long double p) { return curve.area(curve.at(p), -1.0L); };
  Material made{};
  made.sk = slope;
  made.spk = ratio1 > 0.0L ? 2.0L * curve.area(top, 1.0L) / ratio1 : 0.0L;
  made.svk = ratio2 < 1.0L ? 2.0L * curve.area(top - slope, -1.0L) / (1.0L - ratio2) : 0.0L;
  made.smr1 = 100.0L * ratio1;
  made.smr2 = 100.0L * ratio2;
  made.vmp = material(0.1L);
  made.vmc = material(0.8L) - material(0.1L);
  made.vvc = voids(0.1L) - voids(0.8L);
  made.vvv = voids(0.8L);
  made.sxp = curve.at(0.025L) - curve.at(0.5L);
  return made;
}

long double difference_gain(int order, long double phase) {
  switch (order) {
    case 2:
      return std::sin(phase) / phase;
    case 4:
      return (8.0L * std::sin(phase) - std::sin(2.0L * phase)) / (6.0L * phase);
    default:
      return (45.0L * std::sin(phase) - 9.0L * std::sin(2.0L * phase) + std::sin(3.0L * phase)) / (30.0L * phase);
  }
}

int order_at(int point, int count) { return 2 * std::min({point, count - 1 - point, 3}); }

std::vector<long double> autocorrelation_of(const std::vector<long double>& heights_um, int lags) {
  std::vector<long double> correlation;
  const std::size_t count = heights_um.size();
  for (std::size_t lag = 0; lag < static_cast<std::size_t>(lags); ++lag) {
    long double sum = 0.0L;
    for (std::size_t i = 0; i + lag < count; ++i) sum += heights_um[i] * heights_um[i + lag];
    correlation.push_back(sum / static_cast<long double>(count - lag));
  }
  const long double square = correlation.front();
  for (long double& value : correlation) value /= square;
  return correlation;
}

long double between_lags(const std::vector<long double>& correlation, long double lag) {
  const auto left = static_cast<std::size_t>(lag);
  // Neville's scheme over the lags left - 1 to left + 2; the function is even.
  long double column[4];
  for (std::size_t i = 0; i < 4; ++i) column[i] = correlation[left == 0 && i == 0 ? 1 : left + i - 1];
  const long double t = lag - static_cast<long double>(left) + 1.0L;
  for (std::size_t width = 1; width < 4; ++width) {
    for (std::size_t i = 0; i + width < 4; ++i) {
      const auto a = static_cast<long double>(i);
      const auto b = static_cast<long double>(i + width);
      column[i] = ((t - a) * column[i + 1] - (t - b) * column[i]) / (b - a);
    }
  }
  return column[0];
}

}  // namespace fvd::metrology::reference
