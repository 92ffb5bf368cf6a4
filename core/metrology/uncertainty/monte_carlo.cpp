#include "core/metrology/uncertainty/monte_carlo.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>

#include "core/metrology/uncertainty/noise_map.hpp"

namespace fvd::metrology {
namespace {

struct Rectangle {
  int left = 0;
  int top = 0;
  int right = 0;  // one past the last
  int bottom = 0;
};

Rectangle rectangle_of(const HeightField& field, const Region& region, int margin_px) {
  if (region.empty() || margin_px < 0) return {0, 0, field.width(), field.height()};
  Rectangle found{field.width(), field.height(), 0, 0};
  for (int y = 0; y < field.height(); ++y) {
    for (int x = 0; x < field.width(); ++x) {
      if (region.at(x, y) == 0) continue;
      found = {std::min(found.left, x), std::min(found.top, y), std::max(found.right, x + 1),
               std::max(found.bottom, y + 1)};
    }
  }
  if (found.right == 0) return {};
  return {std::max(0, found.left - margin_px), std::max(0, found.top - margin_px),
          std::min(field.width(), found.right + margin_px), std::min(field.height(), found.bottom + margin_px)};
}

template <typename T>
Plane<T> cut(const Plane<T>& plane, const Rectangle& to) {
  if (plane.empty()) return {};
  Plane<T> part(to.right - to.left, to.bottom - to.top);
  for (int y = 0; y < part.height(); ++y) std::copy_n(plane.row(to.top + y) + to.left, part.width(), part.row(y));
  return part;
}

/// Mean and squared deviations of a growing number of values (Welford, 1962).
struct Running {
  int n = 0;
  double mean = 0.0;
  double squares = 0.0;
  void add(double value) {
    ++n;
    const double before = value - mean;
    mean += before / n;
    squares += before * (value - mean);
  }
};

}  // namespace

std::optional<MonteCarlo> monte_carlo(const HeightField& field, const Region& region,
                                      const MonteCarloSettings& settings, const ValuesOfField& values) {
  assert(settings.draws >= 2);
  if (!field.has_sigma()) return std::nullopt;
  const Rectangle part = rectangle_of(field, region, settings.margin_px);
  if (part.right <= part.left) return std::nullopt;
  const HeightField still{cut(field.z_um, part), cut(field.sigma_um, part), field.pitch_x_um, field.pitch_y_um,
                          field.kernel};
  HeightField disturbed = still.clone();
  const Region inside = cut(region, part);

  NoiseMaps noise(still, settings.seed);
  std::vector<Running> sums;
  for (int draw = 0; draw < settings.draws; ++draw) {
    noise.add_to_heights(static_cast<std::uint64_t>(draw), disturbed.z_um);
    const std::vector<std::optional<double>> drawn = values(disturbed, inside);
    if (draw == 0) sums.resize(drawn.size());
    assert(drawn.size() == sums.size());
    for (std::size_t i = 0; i < drawn.size(); ++i) {
      if (drawn[i]) sums[i].add(*drawn[i]);
    }
  }

  MonteCarlo result{{}, settings.seed, settings.draws};
  for (const Running& sum : sums) {
    MonteCarloValue value;
    value.draws = sum.n;
    if (sum.n >= 2 && 10 * sum.n >= 9 * settings.draws) {
      value.u = std::sqrt(sum.squares / (sum.n - 1));
      value.mean = sum.mean;
    }
    result.values.push_back(value);
  }
  return result;
}

}  // namespace fvd::metrology
