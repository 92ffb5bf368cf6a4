#include "core/metrology/operations/robust_plane.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <Eigen/Dense>

#include "core/metrology/operations/plane_sums.hpp"
#include "core/metrology/operations/robust_start.hpp"

namespace fvd::metrology {
namespace {

constexpr double kCut = 4.4478;  ///< in medians of absolute residuals, ISO 16610-31
constexpr int kMaxRounds = 40;
constexpr double kSettled =
    1e-11;  ///< of the cut: far below what is asked for, so that a mirrored surface has the same plane
constexpr double kRounding = 1e-14;  ///< of the heights: what a residual is made of where there is nothing else

/// Points with absolute residuals around the median: how many lie below, and those within.
struct Around {
  std::size_t below = 0;
  std::vector<double> within;
};

/// Residuals in [from, to) by bands; the order within does not matter to an order statistic.
Around collect(const ChosenPoints& points, const Eigen::Vector3d& plane, double from, double to, WorkerPool* pool) {
  const int rows = points.z_um.height();
  std::vector<Around> bands(static_cast<std::size_t>(band_count(rows)));
  run_bands(pool, rows, [&](int band, int first, int end) {
    Around& around = bands[static_cast<std::size_t>(band)];
    const std::size_t columns = points.x.size();
    for (int row = first; row < end; ++row) {
      const double base = plane[0] + plane[2] * points.y[static_cast<std::size_t>(row)];
      const double* z = points.z_um.row(row);
      std::size_t filled = around.within.size();
      around.within.resize(filled + columns);
      std::size_t below = 0;
      for (std::size_t i = 0; i < columns; ++i) {
        const double residual = std::abs(z[i] - (base + plane[1] * points.x[i]));
        below += residual < from ? 1U : 0U;
        around.within[filled] = residual;
        filled += static_cast<std::size_t>(residual >= from) & static_cast<std::size_t>(residual < to);
      }
      around.below += below;
      around.within.resize(filled);
    }
  });
  Around all;
  for (const Around& band : bands) {
    all.below += band.below;
    all.within.insert(all.within.end(), band.within.begin(), band.within.end());
  }
  return all;
}

/// The exact median of the absolute residuals; quick where `guess` is right to `spread`, and right in any case.
double median_residual(const ChosenPoints& points, const Eigen::Vector3d& plane, double guess, double spread,
                       WorkerPool* pool) {
  const std::size_t lower = (points.points - 1) / 2;
  const std::size_t upper = points.points / 2;
  for (;; spread *= 8.0) {
    const bool all = spread >= 1.0 || guess == 0.0;
    const double from = all ? 0.0 : guess * (1.0 - spread);
    const double to = all ? std::numeric_limits<double>::infinity() : guess * (1.0 + spread);
    Around around = collect(points, plane, from, to, pool);
    if (lower < around.below || upper >= around.below + around.within.size()) continue;
    const auto middle = around.within.begin() + static_cast<std::ptrdiff_t>(lower - around.below);
    std::nth_element(around.within.begin(), middle, around.within.end());
    if (lower == upper) return *middle;
    return 0.5 * (*middle + *std::min_element(middle + 1, around.within.end()));
  }
}

double largest_height(const ChosenPoints& points) {
  double largest = 0.0;
  for (const double z : points.z_um.pixels()) largest = std::abs(z) > largest ? std::abs(z) : largest;
  return largest;
}

/// With q = (r / cut)^2: weight (1 - q)^2, psi = weight * r, its derivative (1 - q)(1 - 5 q); 0 beyond the cut.
class Tukey {
 public:
  explicit Tukey(double cut) : inverse_(1.0 / cut) {}
  [[nodiscard]] PointShare weighted(double r) const {
    const double t = rest(r);
    return {t * t, t * t * r};
  }
  [[nodiscard]] PointShare newton(double r) const {
    const double t = rest(r);
    return {t * (5.0 * t - 4.0), t * t * r};
  }
  [[nodiscard]] PointShare scatter(double r) const {
    const double t = rest(r);
    const double psi = t * t * r;
    return {psi * psi, t > 0.0 ? 0.0 : 1.0};
  }

 private:
  [[nodiscard]] double rest(double r) const {
    const double t = 1.0 - r * inverse_ * r * inverse_;
    return t > 0.0 ? t : 0.0;
  }
  double inverse_;
};

/// Newton's step where the curvature carries it, which settles in few rounds; else the step of the weights alone.
std::optional<Eigen::Vector3d> step(const ChosenPoints& points, const Eigen::Vector3d& plane, const Tukey& tukey,
                                    bool newton, WorkerPool* pool) {
  if (newton) {
    const PlaneSums sums =
        sum_plane(points, plane, pool, [tukey](int, std::size_t, double r) { return tukey.newton(r); });
    const Eigen::LLT<Eigen::Matrix3d> solver(sums.matrix);
    if (solver.info() == Eigen::Success && solver.rcond() > 1e-6) return solver.solve(sums.vector);
  }
  const PlaneSums sums =
      sum_plane(points, plane, pool, [tukey](int, std::size_t, double r) { return tukey.weighted(r); });
  const Eigen::LLT<Eigen::Matrix3d> solver(sums.matrix);
  if (solver.info() != Eigen::Success || !(solver.rcond() > 1e-12)) return std::nullopt;
  return solver.solve(sums.vector);
}

/// H^-1 (sum psi^2 u u^T) H^-1 with H = sum psi' u u^T: the asymptotic covariance of an M-estimate (Huber 1981, 7.6).
void add_scatter(RobustPlane& fit, const ChosenPoints& points, WorkerPool* pool) {
  const Tukey tukey(fit.cut_um);
  const PlaneSums curvature =
      sum_plane(points, fit.plane, pool, [tukey](int, std::size_t, double r) { return tukey.newton(r); });
  const PlaneSums scatter =
      sum_plane(points, fit.plane, pool, [tukey](int, std::size_t, double r) { return tukey.scatter(r); });
  const Eigen::Matrix3d inverse = curvature.matrix.inverse();
  fit.covariance = inverse * scatter.matrix * inverse;
  fit.share_without_weight = scatter.vector[0] / static_cast<double>(points.points);
}

}  // namespace

std::optional<RobustPlane> fit_robust_plane(const ChosenPoints& points, WorkerPool* pool) {
  const std::optional<RobustStart> start = robust_start(points);
  if (!start) return std::nullopt;
  const double smallest_cut = std::max(kRounding * largest_height(points), std::numeric_limits<double>::min());
  RobustPlane fit;
  fit.plane = start->plane;
  double median = start->median_um;
  double spread = 0.1;
  for (fit.rounds = 1;; ++fit.rounds) {
    median = median_residual(points, fit.plane, median, spread, pool);
    fit.cut_um = std::max(kCut * median, 8.0 * smallest_cut);
    const auto change = step(points, fit.plane, Tukey(fit.cut_um), fit.rounds > 1, pool);
    if (!change) return std::nullopt;
    fit.plane += *change;
    fit.last_change_um = change->cwiseAbs().sum();
    if (fit.last_change_um <= kSettled * fit.cut_um + 0.1 * smallest_cut || fit.rounds == kMaxRounds) break;
    spread = std::clamp(4.0 * fit.last_change_um / fit.cut_um, 1e-4, 0.1);
  }
  add_scatter(fit, points, pool);
  return fit;
}

}  // namespace fvd::metrology
