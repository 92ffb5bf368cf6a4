#include "core/metrology/step/bottom_curve.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <Eigen/Dense>

namespace fvd::metrology {
namespace {

constexpr int kMostRounds = 50;
constexpr int kMostHalvings = 20;
constexpr double kSettled = 1e-13;  // of a parameter's effect on the heights, over the sizes of the curve

struct Quadratic {
  double centre_um = 0.0;  // of x
  double scale_um = 1.0;
  Eigen::Vector3d coefficients;  // of 1, t, t^2 with t = (x - centre) / scale
};

std::optional<Quadratic> quadratic_through(std::span<const TracePoint> points) {
  if (points.size() < 3) return std::nullopt;
  Quadratic quadratic;
  double sum = 0.0;
  for (const TracePoint& point : points) sum += point.x_um;
  quadratic.centre_um = sum / static_cast<double>(points.size());
  quadratic.scale_um = 0.0;
  for (const TracePoint& point : points) {
    quadratic.scale_um = std::max(quadratic.scale_um, std::abs(point.x_um - quadratic.centre_um));
  }
  if (quadratic.scale_um == 0.0) return std::nullopt;
  Eigen::MatrixXd design(static_cast<Eigen::Index>(points.size()), 3);
  Eigen::VectorXd heights(static_cast<Eigen::Index>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double t = (points[i].x_um - quadratic.centre_um) / quadratic.scale_um;
    design.row(static_cast<Eigen::Index>(i)) << 1.0, t, t * t;
    heights(static_cast<Eigen::Index>(i)) = points[i].z_um;
  }
  const auto decomposed = design.colPivHouseholderQr();
  if (decomposed.rank() < 3) return std::nullopt;
  quadratic.coefficients = decomposed.solve(heights);
  return quadratic;
}

}  // namespace

std::optional<BottomCurve> BottomCurve::fit(std::span<const TracePoint> points, BottomForm form) {
  const std::optional<Quadratic> start = quadratic_through(points);
  if (!start.has_value()) return std::nullopt;
  const Eigen::Vector3d& c = start->coefficients;
  if (!(c(2) > 0.0)) return std::nullopt;
  BottomCurve curve;
  curve.form_ = form;
  curve.x0_um_ = start->centre_um - 0.5 * c(1) / c(2) * start->scale_um;
  curve.z0_um_ = c(0) - 0.25 * c(1) * c(1) / c(2);
  curve.curvature_ = 2.0 * c(2) / (start->scale_um * start->scale_um);
  if (!curve.reaches(points)) return std::nullopt;
  // A parabola is there already.
  for (int round = 0; round < kMostRounds && curve.improve(points); ++round) {
  }
  if (!(curve.curvature_ > 0.0)) return std::nullopt;

  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  for (const TracePoint& point : points) {
    const Vector gradient = curve.gradient(point.x_um);
    const Eigen::Map<const Eigen::Vector3d> column(gradient.data());
    normal += column * column.transpose();
  }
  const Eigen::Matrix3d inverse = normal.inverse();
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j)
      curve.inverse_[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] = inverse(i, j);
  }
  return curve;
}

bool BottomCurve::reaches(std::span<const TracePoint> points) const {
  if (form_ == BottomForm::kParabola) return true;
  return std::all_of(points.begin(), points.end(),
                     [this](const TracePoint& point) { return std::abs(curvature_ * (point.x_um - x0_um_)) < 1.0; });
}

double BottomCurve::z_um(double x_um) const {
  const double u = x_um - x0_um_;
  if (form_ == BottomForm::kParabola) return z0_um_ + 0.5 * curvature_ * u * u;
  return z0_um_ + curvature_ * u * u / (1.0 + std::sqrt(1.0 - curvature_ * curvature_ * u * u));
}

double BottomCurve::slope(double x_um) const {
  const double steep = curvature_ * (x_um - x0_um_);
  return form_ == BottomForm::kParabola ? steep : steep / std::sqrt(1.0 - steep * steep);
}

double BottomCurve::vertex_um(double steepness) const {
  const double steep = form_ == BottomForm::kParabola ? steepness : steepness / std::sqrt(1.0 + steepness * steepness);
  return x0_um_ + steep / curvature_;
}

double BottomCurve::radius_um(double x_um) const {
  if (form_ == BottomForm::kCircle) return 1.0 / curvature_;
  return std::pow(1.0 + slope(x_um) * slope(x_um), 1.5) / curvature_;
}

BottomCurve::Vector BottomCurve::gradient(double x_um) const {
  const double u = x_um - x0_um_;
  if (form_ == BottomForm::kParabola) return {-curvature_ * u, 1.0, 0.5 * u * u};
  const double w = std::sqrt(1.0 - curvature_ * curvature_ * u * u);
  return {-curvature_ * u / w, 1.0, u * u / (w * (1.0 + w))};
}

double BottomCurve::squares(std::span<const TracePoint> points) const {
  double sum = 0.0;
  for (const TracePoint& point : points) sum += std::pow(point.z_um - z_um(point.x_um), 2);
  return sum;
}

bool BottomCurve::improve(std::span<const TracePoint> points) {
  Eigen::MatrixXd design(static_cast<Eigen::Index>(points.size()), 3);
  Eigen::VectorXd residuals(static_cast<Eigen::Index>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vector row = gradient(points[i].x_um);
    design.row(static_cast<Eigen::Index>(i)) << row[0], row[1], row[2];
    residuals(static_cast<Eigen::Index>(i)) = points[i].z_um - z_um(points[i].x_um);
  }
  const Eigen::Vector3d step = design.colPivHouseholderQr().solve(residuals);
  const Eigen::VectorXd moved = design * step;
  const double before = residuals.squaredNorm();
  double share = 1.0;
  for (int halving = 0; halving < kMostHalvings; ++halving, share *= 0.5) {
    BottomCurve next = *this;
    next.x0_um_ += share * step(0);
    next.z0_um_ += share * step(1);
    next.curvature_ += share * step(2);
    if (!next.reaches(points) || next.squares(points) > before) continue;
    *this = next;
    return moved.cwiseAbs().maxCoeff() > kSettled * (std::abs(z0_um_) + 1.0 / std::abs(curvature_));
  }
  return false;
}

double BottomCurve::influence(double at_um, double x_um) const {
  const Vector at = gradient(at_um);
  const Vector of_point = gradient(x_um);
  double sum = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) sum += at[i] * inverse_[i][j] * of_point[j];
  }
  return sum;
}

}  // namespace fvd::metrology
