#include "core/metrology/edge/edge_planes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include <Eigen/Dense>

#include "core/metrology/edge/robust.hpp"

namespace fvd::metrology::edge {
namespace {

constexpr std::size_t kPointsToSearch = 1500;
constexpr std::size_t kPointsToRefine = 40000;
constexpr std::size_t kFewestPoints = 60;
constexpr int kDirections = 8;
constexpr int kHingeRounds = 25;
constexpr int kHuberRounds = 6;
constexpr double kHuberCut = 1.345;
// Planes that turn by less than this (about 6 degrees) make no edge.
constexpr double kLeastTurn = 0.1;
// An edge within 6 degrees of the direction to rake_side has no rake on that side.
constexpr double kLeastSideways = 0.1;

struct Point {
  double x, y, z, weight;
};
using Points = std::vector<Point>;

// z = c0 + c1 x + c2 y
using PlaneOf = Eigen::Vector3d;

double height(const PlaneOf& plane, const Point& p) { return plane[0] + plane[1] * p.x + plane[2] * p.y; }

Points collect(const HeightField& field, const Region& region, std::size_t most, double& middle_x, double& middle_y) {
  std::size_t count = 0;
  middle_x = middle_y = 0.0;
  for (int row = 0; row < field.height(); ++row) {
    for (int column = 0; column < field.width(); ++column) {
      if (field.is_hole(column, row) || !is_inside(region, column, row)) continue;
      ++count;
      middle_x += field.x_um(column);
      middle_y += field.y_um(row);
    }
  }
  if (count == 0) return {};
  middle_x /= static_cast<double>(count);
  middle_y /= static_cast<double>(count);
  const int stride = std::max(1, static_cast<int>(std::sqrt(static_cast<double>(count) / static_cast<double>(most))));
  Points points;
  for (int row = stride / 2; row < field.height(); row += stride) {
    for (int column = stride / 2; column < field.width(); column += stride) {
      if (field.is_hole(column, row) || !is_inside(region, column, row)) continue;
      const double sigma = field.has_sigma() ? static_cast<double>(field.sigma_um.at(column, row)) : 1.0;
      if (!(sigma > 0.0)) continue;
      points.push_back({field.x_um(column) - middle_x, field.y_um(row) - middle_y, field.z_um.at(column, row),
                        1.0 / (sigma * sigma)});
    }
  }
  // No point counts for more than ten of the middle ones.
  std::vector<double> weights;
  for (const Point& p : points) weights.push_back(p.weight);
  if (!weights.empty()) {
    const double typical = median(std::move(weights));
    for (Point& p : points) p.weight = std::min(10.0, p.weight / typical);
  }
  return points;
}

std::optional<PlaneOf> fit(const Points& points, const std::vector<double>& weights) {
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (weights[i] == 0.0) continue;
    const Eigen::Vector3d row(1.0, points[i].x, points[i].y);
    normal += weights[i] * row * row.transpose();
    right += weights[i] * points[i].z * row;
  }
  const Eigen::LDLT<Eigen::Matrix3d> solver(normal);
  const auto d = solver.vectorD().cwiseAbs();
  if (!(d.minCoeff() > 1e-9 * d.maxCoeff())) return std::nullopt;
  return PlaneOf(solver.solve(right));
}

struct Hinge {
  PlaneOf first, second;
  double cost = 0.0;  ///< mean absolute deviation
};

// One hinge from one start. sign +1: the lower plane counts (convex), -1: the higher one. Residuals of earlier rounds
// weigh the points, so that the end is a least sum of absolute deviations.
std::optional<Hinge> hinge_from(const Points& points, double sign, double angle_rad, double offset_um) {
  const auto side = [&](const Point& p) { return p.x * std::cos(angle_rad) + p.y * std::sin(angle_rad) < offset_um; };
  std::vector<double> first(points.size());
  std::vector<double> second(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    first[i] = side(points[i]) ? points[i].weight : 0.0;
    second[i] = points[i].weight - first[i];
  }
  Hinge hinge;
  double cost_before = 0.0;
  for (int round = 0; round < kHingeRounds; ++round) {
    const auto a = fit(points, first);
    const auto b = fit(points, second);
    if (!a || !b) return std::nullopt;
    hinge = {*a, *b, 0.0};
    double scale = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double za = height(*a, points[i]);
      const double zb = height(*b, points[i]);
      const bool in_first = sign * (za - zb) < 0.0;
      const double residual = std::abs(points[i].z - (in_first ? za : zb));
      scale += residual;
      first[i] = in_first ? residual : -1.0;
      second[i] = in_first ? -1.0 : residual;
    }
    hinge.cost = scale / static_cast<double>(points.size());
    const double least = std::max(hinge.cost / 3.0, 1e-9);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double residual = std::max(first[i], second[i]);
      const double weight = points[i].weight * least / std::max(residual, least);
      first[i] = first[i] >= 0.0 ? weight : 0.0;
      second[i] = second[i] >= 0.0 ? weight : 0.0;
    }
    if (round > 3 && std::abs(hinge.cost - cost_before) < 1e-5 * hinge.cost) break;
    cost_before = hinge.cost;
  }
  return hinge;
}

std::optional<Hinge> best_hinge(const Points& points, double sign) {
  std::optional<Hinge> best;
  for (int direction = 0; direction < kDirections; ++direction) {
    const double angle = std::numbers::pi * direction / kDirections;
    std::vector<double> places;
    for (const Point& p : points) places.push_back(p.x * std::cos(angle) + p.y * std::sin(angle));
    for (const double share : {0.3, 0.5, 0.7}) {
      const auto hinge = hinge_from(points, sign, angle, quantile(places, share));
      if (hinge && (!best || hinge->cost < best->cost)) best = hinge;
    }
  }
  return best;
}

// The line in which two planes meet, seen from the middle of the points; second lies where u points.
StraightEdge meet(const PlaneOf& first, const PlaneOf& second) {
  // On the side of the second plane it is the lower one: first - second grows along u.
  const Eigen::Vector2d difference(first[1] - second[1], first[2] - second[2]);
  const Eigen::Vector2d u = difference.normalized();
  const Eigen::Vector2d origin = -(first[0] - second[0]) / difference.norm() * u;
  const Eigen::Vector2d e(-u[1], u[0]);
  return {origin[0],
          origin[1],
          first[0] + first[1] * origin[0] + first[2] * origin[1],
          e[0],
          e[1],
          u[0],
          u[1],
          first[1] * e[0] + first[2] * e[1]};
}

// Both planes anew from what lies in the flanks' range about the present edge.
bool refine(const Points& points, const EdgeOptions& options, Hinge& hinge) {
  for (int round = 0; round < kHuberRounds; ++round) {
    const StraightEdge edge = meet(hinge.first, hinge.second);
    std::array<PlaneOf*, 2> planes{&hinge.first, &hinge.second};
    const std::array<PlaneOf, 2> before{hinge.first, hinge.second};
    for (std::size_t k = 0; k < 2; ++k) {
      std::vector<double> weights(points.size(), 0.0);
      std::vector<double> residuals;
      std::vector<std::size_t> used;
      for (std::size_t i = 0; i < points.size(); ++i) {
        const Point& p = points[i];
        const double across = (p.x - edge.origin_x_um) * edge.u_x + (p.y - edge.origin_y_um) * edge.u_y;
        const double away = k == 0 ? -across : across;
        if (away < options.flank_from_um || away > options.flank_to_um) continue;
        used.push_back(i);
        residuals.push_back(p.z - height(before[k], p));
      }
      if (used.size() < kFewestPoints / 2) return false;
      const double scale = std::max(robust_sd(residuals), 1e-9);
      for (std::size_t n = 0; n < used.size(); ++n) {
        const double size = std::abs(residuals[n]) / scale;
        weights[used[n]] = points[used[n]].weight * std::min(1.0, kHuberCut / std::max(size, 1e-9));
      }
      const auto plane = fit(points, weights);
      if (!plane) return false;
      *planes[k] = *plane;
    }
  }
  return true;
}

// The direction in the image to the side on which the rake lies.
Eigen::Vector2d towards(RakeSide side) {
  switch (side) {
    case RakeSide::kLeft:
      return {-1.0, 0.0};
    case RakeSide::kRight:
      return {1.0, 0.0};
    case RakeSide::kTop:
      return {0.0, -1.0};
    case RakeSide::kBottom:
      return {0.0, 1.0};
  }
  return {-1.0, 0.0};
}

double turn(const Hinge& hinge) {
  return std::hypot(hinge.first[1] - hinge.second[1], hinge.first[2] - hinge.second[2]);
}

}  // namespace

FoundPlanes find_planes(const HeightField& field, const Region& region, const EdgeOptions& options) {
  double middle_x = 0.0;
  double middle_y = 0.0;
  Points points = collect(field, region, kPointsToSearch, middle_x, middle_y);
  if (points.size() < kFewestPoints) return {EdgeReason::kTooFewPoints, {}};
  auto convex = best_hinge(points, 1.0);
  const auto concave = best_hinge(points, -1.0);
  if (!convex || turn(*convex) < kLeastTurn) return {EdgeReason::kNotConvex, {}};
  if (concave && concave->cost < convex->cost) return {EdgeReason::kNotConvex, {}};
  points = collect(field, region, kPointsToRefine, middle_x, middle_y);
  if (!refine(points, options, *convex)) return {EdgeReason::kTooFewPoints, {}};
  if (turn(*convex) < kLeastTurn) return {EdgeReason::kNotConvex, {}};
  StraightEdge edge = meet(convex->first, convex->second);
  const double to_rake = -towards(options.rake_side).dot(Eigen::Vector2d(edge.u_x, edge.u_y));
  if (std::abs(to_rake) < kLeastSideways) return {EdgeReason::kRakeSideAmbiguous, {}};
  // Named the other way round, the planes meet in the same line, and u points to the other side.
  if (to_rake < 0.0) edge = meet(convex->second, convex->first);
  edge.origin_x_um += middle_x;
  edge.origin_y_um += middle_y;
  return {EdgeReason::kNone, edge};
}

}  // namespace fvd::metrology::edge
