#include "core/metrology/operations/robust_start.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include <Eigen/Dense>

namespace fvd::metrology {
namespace {

constexpr std::size_t kSample = 4096;
constexpr std::size_t kJudges = 512;  ///< points that judge each plane
constexpr int kPlanes = 300;
constexpr int kRounds = 30;
constexpr double kCut = 4.4478;         ///< Tukey's cut in medians of absolute residuals, ISO 16610-31
constexpr double kSmallestArea = 0.02;  ///< of three points, in normal coordinates: flatter triangles tell nothing

/// The same numbers in every run. Constants: Knuth, MMIX.
class Sequence {
 public:
  /// 0 <= number < count
  std::size_t next(std::size_t count) {
    state_ = state_ * 6364136223846793005ULL + 1442695040888963407ULL;
    return static_cast<std::size_t>((state_ >> 33U) % count);
  }

 private:
  std::uint64_t state_ = 1;
};

/// (x, y, z) of one point out of every `step` in reading order, which one by the sequence: no pattern of the surface is
/// met in step.
std::vector<Eigen::Vector3d> sample_of(const ChosenPoints& points, Sequence& sequence) {
  const std::size_t step = (points.points + kSample - 1) / kSample;
  std::vector<Eigen::Vector3d> sample;
  std::size_t index = 0;
  std::size_t wanted = sequence.next(step);
  for (int row = 0; row < points.z_um.height(); ++row) {
    const double* z = points.z_um.row(row);
    for (std::size_t i = 0; i < points.x.size(); ++i) {
      if (std::isnan(z[i])) continue;
      if (index == wanted) {
        sample.emplace_back(points.x[i], points.y[static_cast<std::size_t>(row)], z[i]);
        wanted = (index / step + 1) * step + sequence.next(step);
      }
      ++index;
    }
  }
  return sample;
}

double median_residual(const std::vector<Eigen::Vector3d>& sample, std::size_t count, const Eigen::Vector3d& plane,
                       std::vector<double>& scratch) {
  scratch.clear();
  for (std::size_t i = 0; i < count; ++i) {
    // Strides through the sample, so that few judges still come from everywhere.
    const Eigen::Vector3d& p = sample[i * sample.size() / count];
    scratch.push_back(std::abs(p.z() - plane[0] - plane[1] * p.x() - plane[2] * p.y()));
  }
  const auto middle = scratch.begin() + static_cast<std::ptrdiff_t>((count - 1) / 2);
  std::nth_element(scratch.begin(), middle, scratch.end());
  return *middle;
}

std::optional<Eigen::Vector3d> plane_through(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                             const Eigen::Vector3d& c) {
  const Eigen::Vector3d normal = (b - a).cross(c - a);
  if (std::abs(normal.z()) < 2.0 * kSmallestArea) return std::nullopt;
  const double rise_x = -normal.x() / normal.z();
  const double rise_y = -normal.y() / normal.z();
  return Eigen::Vector3d(a.z() - rise_x * a.x() - rise_y * a.y(), rise_x, rise_y);
}

std::optional<Eigen::Vector3d> least_squares(const std::vector<Eigen::Vector3d>& sample, const Eigen::Vector3d& plane,
                                             double cut) {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
  Eigen::Vector3d vector = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p : sample) {
    const Eigen::Vector3d u(1.0, p.x(), p.y());
    const double residual = p.z() - plane.dot(u);
    const double t = std::max(1.0 - residual * residual / (cut * cut), 0.0);
    matrix += t * t * u * u.transpose();
    vector += t * t * residual * u;
  }
  const Eigen::LDLT<Eigen::Matrix3d> solver(matrix);
  if (solver.info() != Eigen::Success || !(solver.rcond() > 1e-12)) return std::nullopt;
  return plane + solver.solve(vector);
}

}  // namespace

std::optional<RobustStart> robust_start(const ChosenPoints& points) {
  if (points.points < 3) return std::nullopt;
  Sequence sequence;
  const std::vector<Eigen::Vector3d> sample = sample_of(points, sequence);
  const std::size_t judges = std::min(kJudges, sample.size());
  std::vector<double> scratch;
  const auto plain = least_squares(sample, Eigen::Vector3d::Zero(), std::numeric_limits<double>::infinity());
  if (!plain) return std::nullopt;
  RobustStart best{*plain, median_residual(sample, judges, *plain, scratch)};
  for (int i = 0; i < kPlanes; ++i) {
    const Eigen::Vector3d& a = sample[sequence.next(sample.size())];
    const Eigen::Vector3d& b = sample[sequence.next(sample.size())];
    const Eigen::Vector3d& c = sample[sequence.next(sample.size())];
    const auto plane = plane_through(a, b, c);
    if (!plane) continue;
    const double median = median_residual(sample, judges, *plane, scratch);
    if (median < best.median_um) best = {*plane, median};
  }
  for (int round = 0; round < kRounds; ++round) {
    best.median_um = median_residual(sample, sample.size(), best.plane, scratch);
    if (best.median_um == 0.0) break;
    const auto next = least_squares(sample, best.plane, kCut * best.median_um);
    if (!next) break;
    const double change = (*next - best.plane).cwiseAbs().sum();
    best.plane = *next;
    if (change < 1e-6 * best.median_um) break;
  }
  return best;
}

}  // namespace fvd::metrology
