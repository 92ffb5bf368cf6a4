#include "core/metrology/areal/height_weights.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

namespace fvd::metrology {

namespace {

/// What the derivatives are made of.
struct Sums {
  int left = 0;
  int top = 0;
  int right = -1;  // last column
  int bottom = -1;
  double points = 0.0;
  double mean_um = 0.0;
  double mean_sign = 0.0;
  double m2 = 0.0;
  double m3 = 0.0;
  double m4 = 0.0;
  int highest_column = 0;
  int highest_row = 0;
  int lowest_column = 0;
  int lowest_row = 0;
};

double sign(double value) { return value > 0.0 ? 1.0 : (value < 0.0 ? -1.0 : 0.0); }

void each_point(const HeightField& field, const Region& region,
                const std::function<void(int column, int row, double z_um)>& visit) {
  for (int row = 0; row < field.height(); ++row) {
    for (int column = 0; column < field.width(); ++column) {
      if (is_inside(region, column, row) && !field.is_hole(column, row)) visit(column, row, field.z_um.at(column, row));
    }
  }
}

Sums sums_of(const HeightField& field, const Region& region) {
  Sums sums;
  sums.left = field.width();
  sums.top = field.height();
  each_point(field, region, [&](int column, int row, double z_um) {
    if (sums.points == 0.0 || z_um > field.z_um.at(sums.highest_column, sums.highest_row)) {
      sums.highest_column = column;
      sums.highest_row = row;
    }
    if (sums.points == 0.0 || z_um < field.z_um.at(sums.lowest_column, sums.lowest_row)) {
      sums.lowest_column = column;
      sums.lowest_row = row;
    }
    sums.left = std::min(sums.left, column);
    sums.right = std::max(sums.right, column);
    sums.top = std::min(sums.top, row);
    sums.bottom = row;
    sums.points += 1.0;
    sums.mean_um += z_um;
  });
  if (sums.points == 0.0) return sums;
  sums.mean_um /= sums.points;
  each_point(field, region, [&sums](int, int, double z_um) {
    const double h = z_um - sums.mean_um;
    sums.mean_sign += sign(h) / sums.points;
    sums.m2 += h * h / sums.points;
    sums.m3 += h * h * h / sums.points;
    sums.m4 += h * h * h * h / sums.points;
  });
  return sums;
}

/// The derivative to a height h over the mean, where the parameter is a mean over all points.
std::function<double(double)> derivative_of(ArealParameter parameter, const Sums& s) {
  const double root = std::sqrt(s.m2);
  switch (parameter) {
    case ArealParameter::kSa:
      return [s](double h) { return (sign(h) - s.mean_sign) / s.points; };
    case ArealParameter::kSq:
      return [s, root](double h) { return h / (s.points * root); };
    case ArealParameter::kSsk:
      return [s, root](double h) {
        const double skewness = s.m3 / (s.m2 * root);
        return 3.0 * ((h * h - s.m2) / (s.m2 * root) - skewness * h / s.m2) / s.points;
      };
    case ArealParameter::kSku:
      return [s](double h) {
        const double kurtosis = s.m4 / (s.m2 * s.m2);
        return 4.0 * ((h * h * h - s.m3) / (s.m2 * s.m2) - kurtosis * h / s.m2) / s.points;
      };
    case ArealParameter::kSp:
      return [s](double) { return -1.0 / s.points; };
    case ArealParameter::kSv:
      return [s](double) { return 1.0 / s.points; };
    case ArealParameter::kSz:
      return [](double) { return 0.0; };
    default:
      return {};
  }
}

bool needs_scatter(ArealParameter parameter) {
  return parameter == ArealParameter::kSq || parameter == ArealParameter::kSsk || parameter == ArealParameter::kSku;
}

}  // namespace

std::optional<WeightMap> height_weights(const HeightField& field, const Region& region, ArealParameter parameter) {
  const Sums sums = sums_of(field, region);
  const auto derivative = derivative_of(parameter, sums);
  if (!derivative || sums.points == 0.0 || (needs_scatter(parameter) && sums.m2 == 0.0)) return std::nullopt;
  WeightMap map;
  map.left = sums.left;
  map.top = sums.top;
  map.weights = Plane<double>(sums.right - sums.left + 1, sums.bottom - sums.top + 1, 0.0);
  each_point(field, region, [&](int column, int row, double z_um) {
    map.weights.at(column - map.left, row - map.top) = derivative(z_um - sums.mean_um);
  });
  const bool with_peak = parameter == ArealParameter::kSp || parameter == ArealParameter::kSz;
  const bool with_pit = parameter == ArealParameter::kSv || parameter == ArealParameter::kSz;
  if (with_peak) map.weights.at(sums.highest_column - map.left, sums.highest_row - map.top) += 1.0;
  if (with_pit) map.weights.at(sums.lowest_column - map.left, sums.lowest_row - map.top) -= 1.0;
  return map;
}

}  // namespace fvd::metrology
