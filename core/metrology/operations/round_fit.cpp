#include "core/metrology/operations/round_fit.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Dense>

#include "core/metrology/operations/round_start.hpp"

namespace fvd::metrology {
namespace {

constexpr int kMaxRounds = 60;
constexpr double kSettled = 1e-13;       ///< rms change of the surface, of the extent of the points
constexpr double kNearlySettled = 1e-9;  ///< the same, where rounding lets the sum of squares fall no further
constexpr double kDamping = 1e-3;        ///< first one on the coarse points; the fine ones start undamped
constexpr double kLargestDamping = 1e10;

template <RoundKind kKind>
class Fitter {
 public:
  static constexpr int kCount = parameters_of(kKind);
  using Vector = Eigen::Matrix<double, kCount, 1>;
  using Matrix = Eigen::Matrix<double, kCount, kCount>;

  struct Sums {
    Matrix matrix = Matrix::Zero();
    Vector vector = Vector::Zero();
    double squares = 0.0;
    double points = 0.0;
  };

  Fitter(const ChosenPoints& points, int step)
      : points_(points), step_(step), extent_um_(std::hypot(points.half_x_um, points.half_y_um)) {}

  /// False where it does not settle.
  bool fit(RoundForm& form, double damping) {
    sums_ = sums_of(form);
    for (int round = 0; round < kMaxRounds; ++round) {
      const auto step = damped_step(damping);
      if (!step) return false;
      const double change_um = std::sqrt(step->dot(sums_.matrix * *step) / sums_.points);
      const RoundForm next = form.template moved<kKind>(*step);
      const Sums next_sums = sums_of(next);
      if (!std::isfinite(change_um)) return false;
      const bool better = next_sums.squares <= sums_.squares;
      if (better) {
        form = next;
        sums_ = next_sums;
        damping = damping < 1e-9 ? 0.0 : damping * 0.1;
      } else {
        damping = std::max(damping * 10.0, 1e-6);
      }
      const bool undamped = damping < kDamping;
      if (undamped && change_um <= kSettled * extent_um_) return true;
      if (!better && change_um <= kNearlySettled * extent_um_) return true;
      if (damping > kLargestDamping) return false;
    }
    return false;
  }

  [[nodiscard]] const Sums& sums() const { return sums_; }
  [[nodiscard]] double extent_um() const { return extent_um_; }

 private:
  [[nodiscard]] Sums sums_of(const RoundForm& form) const {
    Sums sums;
    Vector derivatives;
    for (int row = 0; row < points_.z_um.height(); row += step_) {
      const double* z = points_.z_um.row(row);
      const double y = points_.centre_y_um + points_.half_y_um * points_.y[static_cast<std::size_t>(row)];
      for (std::size_t i = 0; i < points_.x.size(); i += static_cast<std::size_t>(step_)) {
        if (std::isnan(z[i])) continue;
        const Eigen::Vector3d point(points_.centre_x_um + points_.half_x_um * points_.x[i], y, z[i]);
        const double distance = form.template distance<kKind>(point, derivatives);
        sums.matrix.template triangularView<Eigen::Lower>() += derivatives * derivatives.transpose();
        sums.vector += distance * derivatives;
        sums.squares += distance * distance;
        sums.points += 1.0;
      }
    }
    sums.matrix.template triangularView<Eigen::StrictlyUpper>() = sums.matrix.transpose();
    return sums;
  }

  /// Scaled to a unit diagonal: lengths, curvatures and angles share no unit.
  [[nodiscard]] std::optional<Vector> damped_step(double damping) const {
    const Vector scale = sums_.matrix.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
    Matrix scaled = scale.asDiagonal() * sums_.matrix * scale.asDiagonal();
    scaled.diagonal().array() += damping;
    const Eigen::LDLT<Matrix> solver(scaled);
    if (solver.info() != Eigen::Success || !solver.isPositive()) return std::nullopt;
    const Vector step = -(scale.asDiagonal() * solver.solve(scale.asDiagonal() * sums_.vector));
    if (!step.allFinite()) return std::nullopt;
    return step;
  }

  const ChosenPoints& points_;
  int step_;
  double extent_um_;
  Sums sums_;
};

/// The inverse by way of a unit diagonal; absent where the matrix determines nothing.
template <typename Matrix>
std::optional<Matrix> scaled_inverse(const Matrix& matrix) {
  if (!(matrix.diagonal().minCoeff() > 0.0)) return std::nullopt;
  const auto scale = matrix.diagonal().cwiseSqrt().cwiseInverse().eval();
  const Matrix scaled = scale.asDiagonal() * matrix * scale.asDiagonal();
  const Eigen::LLT<Matrix> solver(scaled);
  if (solver.info() != Eigen::Success || !(solver.rcond() > 1e-13)) return std::nullopt;
  return Matrix(scale.asDiagonal() * solver.solve(Matrix::Identity()) * scale.asDiagonal());
}

}  // namespace

template <RoundKind kKind>
std::optional<RoundFit> fit_round(const ChosenPoints& points) {
  std::optional<RoundForm> best;
  double smallest = 0.0;
  for (RoundForm form : round_starts(points, kKind)) {
    Fitter<kKind> coarse(points, coarse_step(points));
    if (!coarse.fit(form, kDamping)) continue;
    if (!best || coarse.sums().squares < smallest) {
      best = form;
      smallest = coarse.sums().squares;
    }
  }
  if (!best) return std::nullopt;
  Fitter<kKind> fitter(points, 1);
  if (!fitter.fit(*best, 0.0)) return std::nullopt;
  const auto& sums = fitter.sums();
  // Flatter than rounding can tell, the radius is not determined.
  if (!(std::abs(best->kappa) * fitter.extent_um() > 1e-9)) return std::nullopt;
  const double freedom = sums.points - parameters_of(kKind);
  const auto inverse = scaled_inverse(sums.matrix);
  if (!inverse) return std::nullopt;
  return RoundFit{*best, *inverse * (freedom > 0.0 ? sums.squares / freedom : 0.0),
                  std::sqrt(sums.squares / sums.points)};
}

template std::optional<RoundFit> fit_round<RoundKind::kSphere>(const ChosenPoints& points);
template std::optional<RoundFit> fit_round<RoundKind::kCylinder>(const ChosenPoints& points);
template std::optional<RoundFit> fit_round<RoundKind::kCone>(const ChosenPoints& points);

}  // namespace fvd::metrology
