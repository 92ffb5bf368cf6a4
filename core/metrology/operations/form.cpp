#include "core/metrology/operations/form.hpp"

#include <cmath>
#include <optional>
#include <string>

#include <Eigen/Dense>

#include "core/base/error.hpp"
#include "core/metrology/operations/chosen_points.hpp"
#include "core/metrology/operations/form_polynomial.hpp"
#include "core/metrology/operations/masking.hpp"
#include "core/metrology/operations/plane_sums.hpp"
#include "core/metrology/operations/plane_values.hpp"
#include "core/metrology/operations/round_fit.hpp"
#include "core/metrology/operations/round_values.hpp"

namespace fvd::metrology {
namespace {

constexpr int kPlaneRounds = 30;

/// Least sum of r^2 / (1 + slope^2), r along z. Where its derivative by a slope is 0,
/// sum of r x = -slope_x * (sum of r^2) / (1 + slope^2): least squares along z with that right side, repeated.
OperationReport remove_plane(HeightField& field, const ChosenPoints& points) {
  Eigen::Vector3d plane = Eigen::Vector3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  PlaneSums sums;
  double stretch = 1.0;  // 1 + slope^2
  const Eigen::Vector3d per_um(0.0, 1.0 / points.half_x_um, 1.0 / points.half_y_um);
  for (int round = 0; round < kPlaneRounds; ++round) {
    sums = sum_plane(points, plane, nullptr, [](int, std::size_t, double r) { return PointShare{1.0, r}; });
    const Eigen::LLT<Eigen::Matrix3d> solver(sums.matrix);
    if (solver.info() != Eigen::Success || !(solver.rcond() > 1e-12)) {
      return refusal("a plane needs three points of the region that do not lie on one line");
    }
    stretch = 1.0 + per_um.cwiseProduct(plane).squaredNorm();
    if (round > 0) right = per_um.cwiseProduct(per_um).cwiseProduct(plane) * (sums.squares / stretch);
    const Eigen::Vector3d change = solver.solve(sums.vector + right);
    plane += change;
    if (round > 1 && change.norm() <= 1e-14 * plane.norm()) break;
  }
  const double freedom = static_cast<double>(points.points) - 3.0;
  const double scatter = freedom > 0.0 ? sums.squares / freedom : 0.0;
  OperationReport report;
  report.points_used = points.points;
  report.values = {{"rms_um", std::sqrt(sums.squares / stretch / static_cast<double>(points.points)), std::nullopt}};
  put_plane_first(report, points, plane, sums.matrix.inverse() * scatter, field.kernel.width_px());
  subtract_plane(field, points, plane, nullptr);
  return report;
}

/// Which of the two roots above a point is the surface: the one that most of the points are nearer to.
bool is_upper_side(const ChosenPoints& points, RoundKind kind, const RoundForm& form) {
  long upper = 0;
  for (int row = 0; row < points.z_um.height(); row += 7) {
    for (std::size_t i = static_cast<std::size_t>(row % 5); i < points.x.size(); i += 5) {
      const double z = points.z_um.row(row)[i];
      if (std::isnan(z)) continue;
      const double x_um = points.centre_x_um + points.half_x_um * points.x[i];
      const double y_um = points.centre_y_um + points.half_y_um * points.y[static_cast<std::size_t>(row)];
      const Heights heights = form.heights_at(kind, x_um, y_um);
      if (!heights.lower_um || !heights.upper_um) continue;
      upper += 2.0 * z > *heights.lower_um + *heights.upper_um ? 1 : -1;
    }
  }
  return upper > 0;
}

/// Number of points without a height of the form.
std::size_t subtract_round(HeightField& field, RoundKind kind, const RoundForm& form, bool upper_side,
                           Plane<MaskReasons>* reasons) {
  std::size_t removed = 0;
  for (int row = 0; row < field.height(); ++row) {
    for (int column = 0; column < field.width(); ++column) {
      if (field.is_hole(column, row)) continue;
      const Heights heights = form.heights_at(kind, field.x_um(column), field.y_um(row));
      const std::optional<double>& near = upper_side ? heights.upper_um : heights.lower_um;
      const std::optional<double>& other = upper_side ? heights.lower_um : heights.upper_um;
      if (near || other) {
        field.z_um.at(column, row) -= near ? *near : *other;
      } else {
        make_hole(field, column, row, reasons, mask_reason::kOutlier);
        ++removed;
      }
    }
  }
  return removed;
}

template <RoundKind kKind>
OperationReport remove_round(HeightField& field, const ChosenPoints& points, const char* name,
                             Plane<MaskReasons>* reasons) {
  const std::string failure = std::string("the points of the region do not determine a ") + name;
  if (points.points < static_cast<std::size_t>(parameters_of(kKind))) return refusal(failure);
  const auto fit = fit_round<kKind>(points);
  if (!fit) return refusal(failure);
  const bool upper = is_upper_side(points, kKind, fit->form);
  OperationReport report;
  report.points_used = points.points;
  report.values = round_values(kKind, *fit, field.kernel.width_px());
  report.values.push_back({"side", upper ? 1.0 : -1.0, std::nullopt});
  report.values.push_back({"rms_um", fit->rms_um, std::nullopt});
  report.points_removed = subtract_round(field, kKind, fit->form, upper, reasons);
  return report;
}

}  // namespace

OperationReport remove_form(HeightField& field, const FormSettings& settings, const Region& region,
                            Plane<MaskReasons>* reasons) {
  if (settings.kind == FormKind::kPolynomial && (settings.degree < 1 || settings.degree > 6)) {
    throw Error(ErrorCode::kBadRecipe, "the degree of a polynomial form must be from 1 to 6");
  }
  const ChosenPoints points = choose_points(field, region, false);
  if (points.points < 3) return refusal("the region has under three points");
  switch (settings.kind) {
    case FormKind::kPlane:
      return remove_plane(field, points);
    case FormKind::kPolynomial:
      return remove_polynomial(field, points, settings.degree);
    case FormKind::kSphere:
      return remove_round<RoundKind::kSphere>(field, points, "sphere", reasons);
    case FormKind::kCylinder:
      return remove_round<RoundKind::kCylinder>(field, points, "cylinder", reasons);
    case FormKind::kCone:
      return remove_round<RoundKind::kCone>(field, points, "cone", reasons);
  }
  return refusal("unknown form");
}

}  // namespace fvd::metrology
