#include "core/metrology/artefact/star_centre.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <vector>

#include <Eigen/Dense>

namespace fvd::metrology {
namespace {

constexpr double kTurn = 2.0 * 3.14159265358979323846;
constexpr double kFullWave = 4.0 / kTurn;  ///< amplitude of the wave in sectors of shares 0 and 1
constexpr int kFewestPairs = 4;
constexpr int kMostPairs = 180;
constexpr std::size_t kFewestEdges = 200;
constexpr int kRounds = 30;
constexpr double kShortestPeriod_px = 8.0;  ///< rings that the centre rests on
constexpr double kWeakest = 0.5;            ///< response of a ring of the star

struct EdgePoint {
  Eigen::Vector2d place_um = Eigen::Vector2d::Zero();
  Eigen::Vector2d normal = Eigen::Vector2d::Zero();
};

std::vector<EdgePoint> edge_points(const HeightField& field, const Plane<float>& shares) {
  constexpr int kLag = 2;
  std::vector<EdgePoint> points;
  for (int y = kLag; y < shares.height() - kLag; ++y) {
    for (int x = kLag; x < shares.width() - kLag; ++x) {
      const double share = static_cast<double>(shares.at(x, y));
      if (!(std::abs(share - 0.5) < 0.2)) continue;
      const double dx = static_cast<double>(shares.at(x + kLag, y) - shares.at(x - kLag, y));
      const double dy = static_cast<double>(shares.at(x, y + kLag) - shares.at(x, y - kLag));
      const Eigen::Vector2d slope(dx / field.pitch_x_um, dy / field.pitch_y_um);
      if (!(std::hypot(dx, dy) > 0.2)) continue;
      points.push_back({{field.x_um(x), field.y_um(y)}, slope.normalized()});
    }
  }
  return points;
}

/// The place that most of the edges point to: least squares of the distances from their lines, far ones ever lighter.
std::optional<Eigen::Vector2d> common_place(const std::vector<EdgePoint>& points) {
  if (points.size() < kFewestEdges) return std::nullopt;
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  double scale = 0.0;
  std::vector<double> distances(points.size());
  for (int round = 0; round < kRounds; ++round) {
    Eigen::Matrix2d matrix = Eigen::Matrix2d::Zero();
    Eigen::Vector2d vector = Eigen::Vector2d::Zero();
    for (const EdgePoint& point : points) {
      const double off = scale > 0.0 ? (centre - point.place_um).dot(point.normal) / scale : 0.0;
      const double weight = 1.0 / (1.0 + off * off);
      matrix += weight * point.normal * point.normal.transpose();
      vector += weight * point.normal * point.normal.dot(point.place_um);
    }
    if (!(matrix.determinant() > 1e-6 * matrix.squaredNorm())) return std::nullopt;
    centre = matrix.inverse() * vector;
    for (std::size_t i = 0; i < points.size(); ++i) {
      distances[i] = std::abs((centre - points[i].place_um).dot(points[i].normal));
    }
    const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
    std::nth_element(distances.begin(), middle, distances.end());
    scale = std::max(*middle, 1e-6);
  }
  return centre;
}

struct Polar {
  double radius_um = 0.0;
  double azimuth = 0.0;
  double share = 0.0;
};

std::vector<Polar> polar_points(const HeightField& field, const Plane<float>& shares, const Eigen::Vector2d& centre) {
  std::vector<Polar> points;
  for (int y = 0; y < shares.height(); ++y) {
    for (int x = 0; x < shares.width(); ++x) {
      const double share = static_cast<double>(shares.at(x, y));
      if (std::isnan(share)) continue;
      const double dx = field.x_um(x) - centre.x();
      const double dy = field.y_um(y) - centre.y();
      points.push_back({std::hypot(dx, dy), std::atan2(dy, dx), share});
    }
  }
  return points;
}

/// Mean shares around the centre by azimuth: the strongest of the waves that may be a star's.
int strongest_pairs(const std::vector<Polar>& points) {
  constexpr std::size_t kBins = 2048;
  std::vector<double> sums(kBins, 0.0);
  std::vector<double> counts(kBins, 0.0);
  for (const Polar& point : points) {
    const double turns = point.azimuth / kTurn + 0.5;
    const auto bin = std::min(kBins - 1, static_cast<std::size_t>(turns * static_cast<double>(kBins)));
    sums[bin] += point.share;
    counts[bin] += 1.0;
  }
  int best = 0;
  double strongest = 0.0;
  for (int pairs = kFewestPairs; pairs <= kMostPairs; ++pairs) {
    std::complex<double> sum;
    for (std::size_t i = 0; i < kBins; ++i) {
      if (counts[i] == 0.0) continue;
      sum += std::polar(sums[i] / counts[i] - 0.5, -kTurn * pairs * (static_cast<double>(i) + 0.5) / kBins);
    }
    if (std::abs(sum) <= strongest) continue;
    strongest = std::abs(sum);
    best = pairs;
  }
  return best;
}

/// Farthest ring that has the star's wave; 0 where none has.
double rim_um(const std::vector<Polar>& points, const StarLayout& star, double ring_um) {
  std::vector<double> waves;
  std::vector<int> counts;
  for (const Polar& point : points) {
    const auto ring = static_cast<std::size_t>(point.radius_um / ring_um);
    if (ring >= waves.size()) {
      waves.resize(ring + 1, 0.0);
      counts.resize(ring + 1, 0);
    }
    waves[ring] += 2.0 * (point.share - 0.5) * std::cos(star.pairs * point.azimuth - star.phase);
    ++counts[ring];
  }
  for (std::size_t ring = waves.size(); ring-- > 0;) {
    const double enough = 0.25 * kTurn * (static_cast<double>(ring) + 0.5);
    if (counts[ring] < enough || waves[ring] < kWeakest * kFullWave * counts[ring]) continue;
    return static_cast<double>(ring + 1) * ring_um;
  }
  return 0.0;
}

/// Gauss-Newton step of centre and phase by the wave's model; false where points do not determine it.
bool improve(StarLayout& star, const HeightField& field, const Plane<float>& shares, double from_um, double to_um) {
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Zero();
  Eigen::Vector4d vector = Eigen::Vector4d::Zero();
  for (int y = 0; y < shares.height(); ++y) {
    for (int x = 0; x < shares.width(); ++x) {
      const double share = static_cast<double>(shares.at(x, y));
      const double dx = field.x_um(x) - star.centre.x;
      const double dy = field.y_um(y) - star.centre.y;
      const double radius = std::hypot(dx, dy);
      if (std::isnan(share) || radius < from_um || radius > to_um) continue;
      const double phase = star.pairs * std::atan2(dy, dx) - star.phase;
      const double fall = -kFullWave * std::sin(phase);  // of the wave, by the phase
      const double turn = star.pairs / (radius * radius);
      // The azimuth falls by dx / r^2 for a centre that moves down, and grows by dy / r^2 for one that moves right.
      const Eigen::Vector4d terms(fall * turn * dy, -fall * turn * dx, -fall, 1.0);
      matrix += terms * terms.transpose();
      vector += terms * (share - 0.5 - kFullWave * std::cos(phase));
    }
  }
  const Eigen::LDLT<Eigen::Matrix4d> solver(matrix);
  if (solver.info() != Eigen::Success || !(solver.rcond() > 1e-12)) return false;
  const Eigen::Vector4d step = solver.solve(vector);
  star.centre.x += step[0];
  star.centre.y += step[1];
  star.phase += step[2];
  return true;
}

double phase_of(const std::vector<Polar>& points, int pairs, double from_um, double to_um) {
  std::complex<double> sum;
  for (const Polar& point : points) {
    if (point.radius_um < from_um || point.radius_um > to_um) continue;
    sum += std::polar(point.share - 0.5, pairs * point.azimuth);
  }
  return std::arg(sum);
}

}  // namespace

std::optional<StarLayout> find_star(const HeightField& field, const Plane<float>& shares, const StarHints& hints) {
  const double ring_um = std::max(field.pitch_x_um, field.pitch_y_um);
  std::optional<Eigen::Vector2d> centre =
      hints.centre ? Eigen::Vector2d(hints.centre->x, hints.centre->y) : common_place(edge_points(field, shares));
  if (!centre) return std::nullopt;
  std::vector<Polar> points = polar_points(field, shares, *centre);
  StarLayout star{{centre->x(), centre->y()}, hints.pairs.value_or(0), 0.0, 0.0};
  if (!hints.pairs) star.pairs = strongest_pairs(points);
  if (star.pairs == 0) return std::nullopt;
  const double inner_um = kShortestPeriod_px * ring_um * star.pairs / kTurn;
  // The rim is where the wave ends, and the phase that the wave needs is that of the rings within the rim.
  star.phase = phase_of(points, star.pairs, inner_um, 1e12);
  star.radius_um = rim_um(points, star, ring_um);
  if (star.radius_um < 1.2 * inner_um) return std::nullopt;
  star.phase = phase_of(points, star.pairs, inner_um, star.radius_um);
  if (!hints.centre) {
    for (int round = 0; round < 8; ++round) {
      if (!improve(star, field, shares, inner_um, 0.95 * star.radius_um)) return std::nullopt;
    }
    points = polar_points(field, shares, {star.centre.x, star.centre.y});
    star.phase = phase_of(points, star.pairs, inner_um, star.radius_um);
  }
  star.radius_um = rim_um(points, star, ring_um);
  if (star.radius_um < 1.2 * inner_um) return std::nullopt;
  return star;
}

}  // namespace fvd::metrology
