#include "core/metrology/areal/height_weights.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <vector>

namespace fvd::metrology {

namespace {

double sign(double value) { return (value > 0.0 ? 1.0 : 0.0) - (value < 0.0 ? 1.0 : 0.0); }

}  // namespace

HeightWeights::HeightWeights(const HeightField& field, const Region& region)
    : field_(field), region_(region), survey_(survey_region(field, region)) {
  if (survey_.points == 0) return;
  std::vector<double> heights_um = valid_heights_um(field, region, survey_);
  const auto [lowest, highest] = std::minmax_element(heights_um.begin(), heights_um.end());
  lowest_um_ = *lowest;
  highest_um_ = *highest;
  mean_um_ = mean_height_um(heights_um);
  double signs = 0.0;  // whole numbers
  for (double& height_um : heights_um) {
    height_um -= mean_um_;
    signs += sign(height_um);
  }
  mean_sign_ = signs / static_cast<double>(survey_.points);
  moments_ = height_moments(heights_um);
}

/// derivative: to a height over the mean.
template <typename Derivative>
WeightMap HeightWeights::mapped(const Derivative& derivative) const {
  const RegionBounds& bounds = survey_.valid;
  WeightMap map{bounds.left, bounds.top, Plane<double>::unset(bounds.width(), bounds.height())};
  for (int row = 0; row < bounds.height(); ++row) {
    const double* z = field_.z_um.row(bounds.top + row) + bounds.left;
    const std::uint8_t* inside = region_.empty() ? nullptr : region_.row(bounds.top + row) + bounds.left;
    double* weights = map.weights.row(row);
    for (int x = 0; x < bounds.width(); ++x) {
      const double weight = derivative(z[x] - mean_um_);
      weights[x] = z[x] == z[x] ? weight : 0.0;
    }
    if (inside == nullptr) continue;
    for (int x = 0; x < bounds.width(); ++x) weights[x] = inside[x] != 0 ? weights[x] : 0.0;
  }
  return map;
}

/// To the first point of this height.
void HeightWeights::add_at(double height_um, double weight, WeightMap& map) const {
  for (int row = 0; row < map.weights.height(); ++row) {
    const double* z = field_.z_um.row(map.top + row) + map.left;
    for (int x = 0; x < map.weights.width(); ++x) {
      if (z[x] != height_um || !is_inside(region_, map.left + x, map.top + row)) continue;
      map.weights.at(x, row) += weight;
      return;
    }
  }
  assert(false);
}

std::optional<WeightMap> HeightWeights::of(ArealParameter parameter) const {
  if (survey_.points == 0) return std::nullopt;
  const auto points = static_cast<double>(survey_.points);
  const double root = moments_.root_mean_square_um;
  const double square = root * root;
  const bool needs_scatter =
      parameter == ArealParameter::kSq || parameter == ArealParameter::kSsk || parameter == ArealParameter::kSku;
  if (needs_scatter && root == 0.0) return std::nullopt;
  std::optional<WeightMap> map;
  switch (parameter) {
    case ArealParameter::kSa:
      return mapped([mean = mean_sign_, points](double h) { return (sign(h) - mean) / points; });
    case ArealParameter::kSq:
      return mapped([divisor = points * root](double h) { return h / divisor; });
    case ArealParameter::kSsk:
      return mapped([=, skewness = moments_.skewness](double h) {
        return 3.0 * ((h * h - square) / (square * root) - skewness * h / square) / points;
      });
    case ArealParameter::kSku:
      return mapped([=, cubes = moments_.skewness * square * root, kurtosis = moments_.kurtosis](double h) {
        return 4.0 * ((h * h * h - cubes) / (square * square) - kurtosis * h / square) / points;
      });
    case ArealParameter::kSp:
      map = mapped([=](double) { return -1.0 / points; });
      add_at(highest_um_, 1.0, *map);
      return map;
    case ArealParameter::kSv:
      map = mapped([=](double) { return 1.0 / points; });
      add_at(lowest_um_, -1.0, *map);
      return map;
    case ArealParameter::kSz:
      map = mapped([](double) { return 0.0; });
      add_at(highest_um_, 1.0, *map);
      add_at(lowest_um_, -1.0, *map);
      return map;
    default:
      return std::nullopt;
  }
}

std::optional<WeightMap> height_weights(const HeightField& field, const Region& region, ArealParameter parameter) {
  return HeightWeights(field, region).of(parameter);
}

}  // namespace fvd::metrology
