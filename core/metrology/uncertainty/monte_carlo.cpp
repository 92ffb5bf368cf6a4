#include "core/metrology/uncertainty/monte_carlo.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>

#include "core/metrology/region_bounds.hpp"
#include "core/metrology/uncertainty/noise_map.hpp"

namespace fvd::metrology {
namespace {

RegionBounds rectangle_of(const HeightField& field, const Region& region, int margin_px) {
  if (region.empty() || margin_px < 0) return {0, 0, field.width(), field.height()};
  const RegionBounds found = bounds_of(region, field.width(), field.height());
  if (found.empty()) return {};
  return {std::max(0, found.left - margin_px), std::max(0, found.top - margin_px),
          std::min(field.width(), found.right + margin_px), std::min(field.height(), found.bottom + margin_px)};
}

template <typename T>
Plane<T> cut(const Plane<T>& plane, const RegionBounds& to) {
  if (plane.empty()) return {};
  Plane<T> part(to.width(), to.height());
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

using Drawn = std::vector<std::optional<double>>;

/// So many draws at a time that they together take no more points than the whole field, which is what is reserved.
int lanes_of(const HeightField& field, const HeightField& part, int draws, const WorkerPool* pool) {
  if (pool == nullptr) return 1;
  const auto points = [](const HeightField& of) { return static_cast<std::int64_t>(of.width()) * of.height(); };
  const std::int64_t most = std::clamp<std::int64_t>(points(field) / points(part), 1, pool->threads());
  return static_cast<int>(std::min<std::int64_t>(most, draws));
}

/// The values of each draw; which thread makes one does not change it.
std::vector<Drawn> all_draws(const HeightField& still, const Region& inside, const MonteCarloSettings& settings,
                             const ValuesOfField& values, int lanes, WorkerPool* pool) {
  std::vector<Drawn> drawn(static_cast<std::size_t>(settings.draws));
  const auto lane = [&](int first) {
    HeightField disturbed = still.clone();
    NoiseMaps noise(still, settings.seed);
    for (int draw = first; draw < settings.draws; draw += lanes) {
      noise.add_to_heights(static_cast<std::uint64_t>(draw), disturbed.z_um);
      drawn[static_cast<std::size_t>(draw)] = values(disturbed, inside);
    }
  };
  if (lanes == 1) {
    lane(0);
  } else {
    pool->run(lanes, std::ref(lane));
  }
  return drawn;
}

}  // namespace

std::optional<MonteCarlo> monte_carlo(const HeightField& field, const Region& region,
                                      const MonteCarloSettings& settings, const ValuesOfField& values,
                                      WorkerPool* pool) {
  assert(settings.draws >= 2);
  if (!field.has_sigma()) return std::nullopt;
  const RegionBounds part = rectangle_of(field, region, settings.margin_px);
  if (part.empty()) return std::nullopt;
  const HeightField still{cut(field.z_um, part), cut(field.sigma_um, part), field.pitch_x_um, field.pitch_y_um,
                          field.kernel};
  const Region inside = cut(region, part);

  std::vector<Running> sums;
  const int lanes = lanes_of(field, still, settings.draws, pool);
  for (const Drawn& drawn : all_draws(still, inside, settings, values, lanes, pool)) {
    if (sums.empty()) sums.resize(drawn.size());
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
