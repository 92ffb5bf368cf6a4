#include "core/metrology/areal/height_weights.hpp"

#include <cassert>
#include <cmath>
#include <cstdint>
#include <vector>

namespace fvd::metrology {

namespace {

double sign(double value) { return (value > 0.0 ? 1.0 : 0.0) - (value < 0.0 ? 1.0 : 0.0); }

}  // namespace

/// derivative: to a height over the mean.
template <typename Derivative>
WeightMap HeightWeights::mapped(const Derivative& derivative) const {
  const RegionBounds& bounds = statistics_.survey.valid;
  WeightMap map{bounds.left, bounds.top, Plane<double>::unset(bounds.width(), bounds.height())};
  for (int row = 0; row < bounds.height(); ++row) {
    const double* z = field_.z_um.row(bounds.top + row) + bounds.left;
    const std::uint8_t* inside = region_.empty() ? nullptr : region_.row(bounds.top + row) + bounds.left;
    double* weights = map.weights.row(row);
    for (int x = 0; x < bounds.width(); ++x) {
      const double weight = derivative(z[x] - statistics_.mean_um);
      weights[x] = z[x] == z[x] ? weight : 0.0;
    }
    if (inside == nullptr) continue;
    for (int x = 0; x < bounds.width(); ++x) weights[x] = inside[x] != 0 ? weights[x] : 0.0;
  }
  return map;
}

/// To the first of the highest points, or of the lowest.
void HeightWeights::add_at_extreme(bool highest, double weight, WeightMap& map) const {
  const double* extreme = nullptr;
  double* there = nullptr;
  for (int row = 0; row < map.weights.height(); ++row) {
    const double* z = field_.z_um.row(map.top + row) + map.left;
    for (int x = 0; x < map.weights.width(); ++x) {
      if (std::isnan(z[x]) || !is_inside(region_, map.left + x, map.top + row)) continue;
      if (extreme != nullptr && !(highest ? z[x] > *extreme : z[x] < *extreme)) continue;
      extreme = z + x;
      there = &map.weights.at(x, row);
    }
  }
  assert(there != nullptr);
  *there += weight;
}

std::optional<WeightMap> HeightWeights::of(ArealParameter parameter) const {
  if (statistics_.survey.points == 0) return std::nullopt;
  const auto points = static_cast<double>(statistics_.survey.points);
  const double root = statistics_.moments.root_mean_square_um;
  const double square = root * root;
  const bool needs_scatter =
      parameter == ArealParameter::kSq || parameter == ArealParameter::kSsk || parameter == ArealParameter::kSku;
  if (needs_scatter && root == 0.0) return std::nullopt;
  std::optional<WeightMap> map;
  switch (parameter) {
    case ArealParameter::kSa:
      return mapped([mean = statistics_.mean_sign, points](double h) { return (sign(h) - mean) / points; });
    case ArealParameter::kSq:
      return mapped([divisor = points * root](double h) { return h / divisor; });
    case ArealParameter::kSsk:
      return mapped([=, skewness = statistics_.moments.skewness](double h) {
        return 3.0 * ((h * h - square) / (square * root) - skewness * h / square) / points;
      });
    case ArealParameter::kSku:
      return mapped(
          [=, cubes = statistics_.moments.skewness * square * root, kurtosis = statistics_.moments.kurtosis](double h) {
            return 4.0 * ((h * h * h - cubes) / (square * square) - kurtosis * h / square) / points;
          });
    case ArealParameter::kSp:
      map = mapped([=](double) { return -1.0 / points; });
      add_at_extreme(true, 1.0, *map);
      return map;
    case ArealParameter::kSv:
      map = mapped([=](double) { return 1.0 / points; });
      add_at_extreme(false, -1.0, *map);
      return map;
    case ArealParameter::kSz:
      map = mapped([](double) { return 0.0; });
      add_at_extreme(true, 1.0, *map);
      add_at_extreme(false, -1.0, *map);
      return map;
    default:
      return std::nullopt;
  }
}

std::optional<WeightMap> height_weights(const HeightField& field, const Region& region, ArealParameter parameter) {
  std::vector<double> heights_um;
  return HeightWeights(field, region, height_statistics(field, region, heights_um)).of(parameter);
}

}  // namespace fvd::metrology
