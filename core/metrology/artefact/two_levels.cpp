#include "core/metrology/artefact/two_levels.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Dense>

namespace fvd::metrology {
namespace {

constexpr int kFewestPoints = 1000;
constexpr int kLag_px = 4;  ///< near enough that most neighbours lie on one level
constexpr std::size_t kMostSamples = 200000;
constexpr std::size_t kMostPoints = 500000;
constexpr double kNear = 0.15;        ///< of the step: so near to a level is on it
constexpr double kMostBetween = 0.9;  ///< points half-way, over those at the level that has fewer
constexpr int kRounds = 6;

struct Point {
  double column = 0.0;
  double row = 0.0;
  double z_um = 0.0;
};

/// Every n-th point of a large field: its levels are certain enough from half a million.
std::vector<Point> valid_points(const HeightField& field, const Region& region) {
  const std::size_t all = static_cast<std::size_t>(field.width()) * static_cast<std::size_t>(field.height());
  const std::size_t every = all / kMostPoints + 1;
  std::size_t number = 0;
  std::vector<Point> points;
  for (int y = 0; y < field.height(); ++y) {
    for (int x = 0; x < field.width(); ++x) {
      if (number++ % every != 0) continue;
      const double z = field.z_um.at(x, y);
      if (!std::isnan(z) && is_inside(region, x, y)) points.push_back({1.0 * x, 1.0 * y, z});
    }
  }
  return points;
}

/// The middle of the majority: where half of the values lie closest together, then the mean of those near it, so that
/// the steps of an edge that all go one way do not pull.
double majority(std::vector<double> values) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  const std::size_t half = (values.size() + 1) / 2;
  std::size_t best = 0;
  for (std::size_t i = 0; i + half <= values.size(); ++i) {
    if (values[i + half - 1] - values[i] < values[best + half - 1] - values[best]) best = i;
  }
  const double reach = values[best + half - 1] - values[best];
  double middle = values[best] + 0.5 * reach;
  for (int round = 0; round < kRounds; ++round) {
    double sum = 0.0;
    int count = 0;
    for (const double value : values) {
      if (std::abs(value - middle) > reach) continue;
      sum += value;
      ++count;
    }
    if (count > 0) middle = sum / count;
  }
  return middle;
}

/// Rise of one pixel along x or along y.
double majority_rise(const HeightField& field, const Region& region, bool along_x) {
  const int dx = along_x ? kLag_px : 0;
  const int dy = along_x ? 0 : kLag_px;
  const std::size_t all = static_cast<std::size_t>(field.width()) * static_cast<std::size_t>(field.height());
  const std::size_t every = all / kMostSamples + 1;
  std::vector<double> rises;
  std::size_t number = 0;
  for (int y = 0; y + dy < field.height(); ++y) {
    for (int x = 0; x + dx < field.width(); ++x) {
      if (number++ % every != 0 || !is_inside(region, x, y) || !is_inside(region, x + dx, y + dy)) continue;
      const double rise = field.z_um.at(x + dx, y + dy) - field.z_um.at(x, y);
      if (!std::isnan(rise)) rises.push_back(rise / kLag_px);
    }
  }
  return majority(std::move(rises));
}

/// Otsu's threshold over a histogram: means below and above it.
std::optional<std::array<double, 2>> class_means(std::vector<double> values) {
  constexpr std::size_t kBins = 512;
  const auto rank = [&](double share) {
    const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), values.begin() + at, values.end());
    return values[static_cast<std::size_t>(at)];
  };
  const double low = rank(0.002);
  const double high = rank(0.998);
  if (!(high > low)) return std::nullopt;
  std::array<double, kBins> counts{};
  for (const double value : values) {
    const double at = std::clamp((value - low) / (high - low), 0.0, 1.0) * (kBins - 1.0);
    counts[static_cast<std::size_t>(at + 0.5)] += 1.0;
  }
  double all = 0.0;
  double moment = 0.0;
  for (std::size_t i = 0; i < kBins; ++i) {
    all += counts[i];
    moment += counts[i] * static_cast<double>(i);
  }
  double below = 0.0;
  double moment_below = 0.0;
  double best = 0.0;
  std::array<double, 2> means{};
  for (std::size_t i = 0; i + 1 < kBins; ++i) {
    below += counts[i];
    moment_below += counts[i] * static_cast<double>(i);
    if (below == 0.0 || below == all) continue;
    const double lower = moment_below / below;
    const double upper = (moment - moment_below) / (all - below);
    const double between = below * (all - below) * (upper - lower) * (upper - lower);
    if (between <= best) continue;
    best = between;
    means = {lower, upper};
  }
  for (double& mean : means) mean = low + mean / (kBins - 1.0) * (high - low);
  return means[1] > means[0] ? std::optional(means) : std::nullopt;
}

/// Plane and step from the points near a level; absent where they do not determine them.
std::optional<TwoLevels> fitted(const std::vector<Point>& points, const TwoLevels& before) {
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Zero();
  Eigen::Vector4d vector = Eigen::Vector4d::Zero();
  for (const Point& point : points) {
    const double share = before.share(point.column, point.row, point.z_um);
    const bool upper = share > 0.5;
    if (std::abs(share - (upper ? 1.0 : 0.0)) > kNear) continue;
    const Eigen::Vector4d terms(1.0, point.column, point.row, upper ? 1.0 : 0.0);
    matrix += terms * terms.transpose();
    vector += terms * point.z_um;
  }
  const Eigen::LDLT<Eigen::Matrix4d> solver(matrix);
  if (solver.info() != Eigen::Success || !(solver.rcond() > 1e-12)) return std::nullopt;
  const Eigen::Vector4d solution = solver.solve(vector);
  if (!(solution[3] > 0.0)) return std::nullopt;
  return TwoLevels{solution[0], solution[1], solution[2], solution[3]};
}

/// Points at the lower level, half-way and at the upper level, of ranges of equal length.
std::array<int, 3> counted(const std::vector<Point>& points, const TwoLevels& levels) {
  std::array<int, 3> counts{};
  for (const Point& point : points) {
    const double share = levels.share(point.column, point.row, point.z_um);
    for (std::size_t i = 0; i < 3; ++i) counts[i] += std::abs(share - 0.5 * static_cast<double>(i)) < kNear ? 1 : 0;
  }
  return counts;
}

/// Feet and shoulders of edges pull the levels towards each other; the plateaus do not.
TwoLevels settled(const std::vector<Point>& points, const TwoLevels& levels) {
  std::array<std::vector<double>, 2> off;
  for (const Point& point : points) {
    const double share = levels.share(point.column, point.row, point.z_um);
    const bool upper = share > 0.5;
    const double from_level = share - (upper ? 1.0 : 0.0);
    if (std::abs(from_level) < kNear) off[upper ? 1 : 0].push_back(from_level * levels.step_um);
  }
  const double lower = majority(std::move(off[0]));
  const double upper = majority(std::move(off[1]));
  return {levels.offset_um + lower, levels.rise_x_um, levels.rise_y_um, levels.step_um + upper - lower};
}

}  // namespace

StudyOutcome<TwoLevels> two_levels(const HeightField& field, const Region& region, Between between) {
  const std::vector<Point> points = valid_points(field, region);
  if (points.size() < kFewestPoints) {
    return StudyRefusal{std::to_string(points.size()) + " points are valid, at least " + std::to_string(kFewestPoints) +
                        " are needed"};
  }
  const StudyRefusal no_levels{"the heights have no two levels of one slope with fewer points between them"};
  TwoLevels levels;
  levels.rise_x_um = majority_rise(field, region, true);
  levels.rise_y_um = majority_rise(field, region, false);
  std::vector<double> flat;
  flat.reserve(points.size());
  for (const Point& p : points) flat.push_back(p.z_um - levels.rise_x_um * p.column - levels.rise_y_um * p.row);
  const auto means = class_means(std::move(flat));
  if (!means) return no_levels;
  levels.offset_um = (*means)[0];
  levels.step_um = (*means)[1] - (*means)[0];
  for (int round = 0; round < kRounds; ++round) {
    const std::optional<TwoLevels> next = fitted(points, levels);
    if (!next) return no_levels;
    levels = *next;
  }
  const std::array<int, 3> counts = counted(points, levels);
  if (between == Between::kRare && counts[1] >= kMostBetween * std::min(counts[0], counts[2])) return no_levels;
  return settled(points, levels);
}

Plane<float> level_shares(const HeightField& field, const Region& region, const TwoLevels& levels) {
  Plane<float> shares(field.width(), field.height(), std::numeric_limits<float>::quiet_NaN());
  for (int y = 0; y < field.height(); ++y) {
    for (int x = 0; x < field.width(); ++x) {
      const double z = field.z_um.at(x, y);
      if (std::isnan(z) || !is_inside(region, x, y)) continue;
      shares.at(x, y) = static_cast<float>(std::clamp(levels.share(x, y, z), -0.5, 1.5));
    }
  }
  return shares;
}

}  // namespace fvd::metrology
