#include "core/metrology/operations/round_form.hpp"

#include <utility>

namespace fvd::metrology {

// |d|^2 - (d a)^2 = (radius + slope * d a)^2 for the point d from the centre, on the vertical line d = d0 + z unit_z;
// of a sphere |d|^2 = radius^2.
Heights RoundForm::heights_at(RoundKind kind, double x_um, double y_um) const {
  const Eigen::Vector3d c = centre();
  const Eigen::Vector3d d0(x_um - c.x(), y_um - c.y(), 0.0);
  const double radius = 1.0 / std::abs(kappa);
  const double slope = kind == RoundKind::kCone ? radius_slope() : 0.0;
  const double axial = kind == RoundKind::kSphere ? 0.0 : 1.0 + slope * slope;
  const double along = d0.dot(a);
  const double two = 1.0 - axial * a.z() * a.z();
  const double one = -axial * along * a.z() - radius * slope * a.z();  // half of the linear term
  const double none = d0.squaredNorm() - axial * along * along - 2.0 * radius * slope * along - radius * radius;
  const double discriminant = one * one - two * none;
  Heights heights;
  if (!(discriminant >= 0.0)) return heights;
  const double q = -(one + std::copysign(std::sqrt(discriminant), one));
  const auto take = [&](std::optional<double>& to, double z) {
    if (std::isfinite(z) && radius + slope * (along + z * a.z()) >= 0.0) to = z + c.z();  // not the other cone's half
  };
  double first = q / two;
  double second = q == 0.0 ? first : none / q;
  if (first > second) std::swap(first, second);
  take(heights.lower_um, first);
  take(heights.upper_um, second);
  return heights;
}

}  // namespace fvd::metrology
