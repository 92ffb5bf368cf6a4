#include "core/metrology/operations/round_start.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/Dense>

namespace fvd::metrology {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kCoarsePoints = 20000.0;
constexpr double kRightAngle_rad = 1.5707963267948966;

template <typename Visit>
void visit_coarse(const ChosenPoints& points, const Visit& visit) {
  const int step = coarse_step(points);
  for (int row = 0; row < points.z_um.height(); row += step) {
    for (int column = 0; column < points.z_um.width(); column += step) {
      const double z = points.z_um.at(column, row);
      if (!std::isnan(z)) {
        visit(points.x[static_cast<std::size_t>(column)], points.y[static_cast<std::size_t>(row)], z);
      }
    }
  }
}

/// z = c0 + c1 x + c2 y + c3 x^2 + c4 x y + c5 y^2 in normal coordinates.
std::optional<Eigen::Matrix<double, 6, 1>> paraboloid(const ChosenPoints& points) {
  Eigen::Matrix<double, 6, 6> matrix = Eigen::Matrix<double, 6, 6>::Zero();
  Eigen::Matrix<double, 6, 1> vector = Eigen::Matrix<double, 6, 1>::Zero();
  visit_coarse(points, [&](double x, double y, double z) {
    Eigen::Matrix<double, 6, 1> u;
    u << 1.0, x, y, x * x, x * y, y * y;
    matrix += u * u.transpose();
    vector += z * u;
  });
  const Eigen::LLT<Eigen::Matrix<double, 6, 6>> solver(matrix);
  if (solver.info() != Eigen::Success || !(solver.rcond() > 1e-10)) return std::nullopt;
  return solver.solve(vector);
}

/// The surface at the block's middle: height, gradient and second derivatives, in um.
struct Tangent {
  double height = 0.0;
  Vector2d gradient;
  Matrix2d hessian;
};

Tangent tangent_of(const ChosenPoints& points, const Eigen::Matrix<double, 6, 1>& c) {
  const double hx = points.half_x_um;
  const double hy = points.half_y_um;
  Tangent tangent;
  tangent.height = c[0];
  tangent.gradient << c[1] / hx, c[2] / hy;
  tangent.hessian << 2.0 * c[3] / (hx * hx), c[4] / (hx * hy), c[4] / (hx * hy), 2.0 * c[5] / (hy * hy);
  return tangent;
}

/// The form that touches the surface there, bent by `kappa` in the direction `bent` of the image.
RoundForm touching(const ChosenPoints& points, const Tangent& tangent, Vector2d bent, double kappa) {
  RoundForm form;
  form.origin = Vector3d(points.centre_x_um, points.centre_y_um, tangent.height);
  form.n = Vector3d(-tangent.gradient.x(), -tangent.gradient.y(), 1.0).normalized();
  const Vector3d in_plane(bent.x(), bent.y(), tangent.gradient.dot(bent));
  form.e = (in_plane - in_plane.dot(form.n) * form.n).normalized();
  form.a = form.e.cross(form.n);
  form.kappa = kappa;
  return form;
}

/// The axis upright through the paraboloid's vertex, and the slope of heights against the distance from it.
std::optional<RoundForm> upright_cone(const ChosenPoints& points, const Tangent& tangent) {
  const Vector2d vertex = -tangent.hessian.fullPivLu().solve(tangent.gradient);
  if (!vertex.allFinite()) return std::nullopt;
  double n = 0.0, r = 0.0, z = 0.0, rr = 0.0, rz = 0.0;
  visit_coarse(points, [&](double x, double y, double height) {
    const double d = std::hypot(x * points.half_x_um - vertex.x(), y * points.half_y_um - vertex.y());
    n += 1.0;
    r += d;
    z += height;
    rr += d * d;
    rz += d * height;
  });
  const double variance = rr - r * r / n;
  const double slope = (rz - r * z / n) / variance;
  if (!(variance > 0.0) || slope == 0.0 || !(r > 0.0)) return std::nullopt;
  RoundForm form;  // its frame stands upright
  form.origin = Vector3d(points.centre_x_um + vertex.x(), points.centre_y_um + vertex.y(), z / n);
  form.kappa = n / r;
  form.rho = -r / n;
  form.taper_rad = std::copysign(kRightAngle_rad, slope) - std::atan(slope);
  return form;
}

}  // namespace

int coarse_step(const ChosenPoints& points) {
  return std::max(1, static_cast<int>(std::sqrt(static_cast<double>(points.points) / kCoarsePoints)));
}

std::vector<RoundForm> round_starts(const ChosenPoints& points, RoundKind kind) {
  const auto coefficients = paraboloid(points);
  if (!coefficients) return {};
  const Tangent tangent = tangent_of(points, *coefficients);
  // The shape operator of a graph: I^-1 II, whose eigenvalues are the principal curvatures.
  const Matrix2d first = Matrix2d::Identity() + tangent.gradient * tangent.gradient.transpose();
  const Matrix2d second = tangent.hessian / std::sqrt(1.0 + tangent.gradient.squaredNorm());
  const Eigen::GeneralizedSelfAdjointEigenSolver<Matrix2d> curvatures(second, first);
  std::vector<RoundForm> starts;
  if (kind == RoundKind::kSphere) {
    starts.push_back(touching(points, tangent, Vector2d::UnitX(), curvatures.eigenvalues().mean()));
    return starts;
  }
  for (int i = 0; i < 2; ++i) {
    starts.push_back(touching(points, tangent, curvatures.eigenvectors().col(i), curvatures.eigenvalues()[i]));
  }
  if (kind == RoundKind::kCone) {
    if (const auto upright = upright_cone(points, tangent)) starts.push_back(*upright);
  }
  return starts;
}

}  // namespace fvd::metrology
