#pragma once

/// Spheres, cylinders and cones in a form that stays well determined where their radius is large.

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/Core>

namespace fvd::metrology {

enum class RoundKind { kSphere, kCylinder, kCone };

/// Number of fitted parameters, in the order of RoundForm::moved().
[[nodiscard]] constexpr int parameters_of(RoundKind kind) {
  return kind == RoundKind::kSphere ? 4 : kind == RoundKind::kCylinder ? 5 : 6;
}

/// Two roots of a vertical line through the form.
struct Heights {
  std::optional<double> lower_um;
  std::optional<double> upper_um;
};

/// A right-handed frame of three unit vectors, e, n and a, at `origin`. Near the middle of the points the surface
/// passes through q = origin + u e + rho n (+ v a), at right angles to n, and is curved by `kappa`, positive towards n.
/// The centre, or the axis' point beside the origin, lies at q + n / kappa; the axis runs along a. `taper_rad`: the
/// distance from the axis, times the sign of kappa, grows by its tangent along a.
/// Distances after Lukacs, Martin and Marshall, "Faithful least-squares fitting of spheres, cylinders, cones and tori"
/// (ECCV 1998): no difference of large numbers, and a plane is just kappa = 0.
struct RoundForm {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  Eigen::Vector3d e = Eigen::Vector3d::UnitX();
  Eigen::Vector3d n = Eigen::Vector3d::UnitY();
  Eigen::Vector3d a = Eigen::Vector3d::UnitZ();
  double u = 0.0;
  double rho = 0.0;
  double kappa = 0.0;
  double v = 0.0;  ///< of a sphere; else 0
  double taper_rad = 0.0;

  /// The signed distance of `point` at right angles to the surface, and its derivatives by the parameters.
  template <RoundKind kKind>
  [[nodiscard]] double distance(const Eigen::Vector3d& point,
                                Eigen::Matrix<double, parameters_of(kKind), 1>& derivatives) const;

  /// u, rho, kappa and: v of a sphere; else the turns of a towards e and towards n, and of a cone the taper.
  template <RoundKind kKind>
  [[nodiscard]] RoundForm moved(const Eigen::Matrix<double, parameters_of(kKind), 1>& step) const;

  /// Centre, or the point of the axis nearest to the origin. kappa is not 0.
  [[nodiscard]] Eigen::Vector3d centre() const { return origin + u * e + v * a + (rho + 1.0 / kappa) * n; }
  /// Change of the radius along a.
  [[nodiscard]] double radius_slope() const { return std::copysign(std::tan(taper_rad), taper_rad * kappa); }
  [[nodiscard]] Heights heights_at(RoundKind kind, double x_um, double y_um) const;
};

template <RoundKind kKind>
double RoundForm::distance(const Eigen::Vector3d& point,
                           Eigen::Matrix<double, parameters_of(kKind), 1>& derivatives) const {
  const Eigen::Vector3d p = point - origin;
  const double across = p.dot(e);
  const double along = p.dot(a);
  const double up = p.dot(n);
  const double x = across - u;
  const double z = up - rho;
  const double w = kKind == RoundKind::kSphere ? along - v : 0.0;
  const double squares = x * x + z * z + w * w;
  const double t = 0.5 * kappa * squares - z;
  const double root = std::sqrt(std::max(1.0 + 2.0 * kappa * t, 1e-30));  // |kappa| times the distance from the axis
  const double radial = 2.0 * t / (1.0 + root);
  const double by_t = 1.0 / root;
  derivatives[0] = -kappa * x * by_t;
  derivatives[1] = (1.0 - kappa * z) * by_t;
  derivatives[2] = 0.5 * (squares - radial * radial) * by_t;
  if constexpr (kKind == RoundKind::kSphere) {
    derivatives[3] = -kappa * w * by_t;
    return radial;
  } else {
    derivatives[3] = -kappa * x * along * by_t;
    derivatives[4] = (1.0 - kappa * z) * along * by_t;
    if constexpr (kKind == RoundKind::kCylinder) {
      return radial;
    } else {
      const double c = std::cos(taper_rad);
      const double s = std::sin(taper_rad);
      derivatives.template head<5>() *= c;
      derivatives[3] -= s * across;
      derivatives[4] -= s * up;
      derivatives[5] = -s * radial - c * along;
      return c * radial - s * along;
    }
  }
}

template <RoundKind kKind>
RoundForm RoundForm::moved(const Eigen::Matrix<double, parameters_of(kKind), 1>& step) const {
  RoundForm next = *this;
  next.u += step[0];
  next.rho += step[1];
  next.kappa += step[2];
  if constexpr (kKind == RoundKind::kSphere) {
    next.v += step[3];
  } else {
    next.a = (a + step[3] * e + step[4] * n).normalized();
    next.n = (n - next.a.dot(n) * next.a).normalized();
    next.e = next.n.cross(next.a);
    if constexpr (kKind == RoundKind::kCone) next.taper_rad += step[5];
  }
  return next;
}

}  // namespace fvd::metrology
