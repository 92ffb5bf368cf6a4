#include "core/metrology/operations/round_values.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include <Eigen/Dense>

namespace fvd::metrology {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;
constexpr double kSmallestTaper_deg = 0.001;  ///< below it the apex is too far away to be named
constexpr double kSmallestCosine = 1e-6;      ///< of the elevation: an upright axis has no azimuth

/// Values with standard errors by first-order propagation.
class Values {
 public:
  Values(const RoundFit& fit, double kernel_width_px) : fit_(fit), width_(kernel_width_px) {}

  void add(const std::string& name, double value, const Eigen::RowVectorXd& derivatives) {
    const double variance = (derivatives * fit_.covariance * derivatives.transpose()).value();
    values.push_back({name, value, std::sqrt(std::max(variance, 0.0)) * width_});
  }
  void add(const std::string& name, double value) { values.push_back({name, value, std::nullopt}); }

  std::vector<NamedValue> values;

 private:
  const RoundFit& fit_;
  double width_;
};

/// d centre / d parameters: [x, y, z][parameter].
Eigen::MatrixXd centre_derivatives(RoundKind kind, const RoundForm& form) {
  Eigen::MatrixXd by = Eigen::MatrixXd::Zero(3, parameters_of(kind));
  by.col(0) = form.e;
  by.col(1) = form.n;
  by.col(2) = -form.n / (form.kappa * form.kappa);
  if (kind == RoundKind::kSphere) {
    by.col(3) = form.a;
  } else {  // e and n turn with a
    by.col(3) = -form.u * form.a;
    by.col(4) = -(form.rho + 1.0 / form.kappa) * form.a;
  }
  return by;
}

void add_centre(Values& values, RoundKind kind, const RoundForm& form, const std::string& prefix) {
  const Eigen::Vector3d centre = form.centre();
  const Eigen::MatrixXd by = centre_derivatives(kind, form);
  values.add(prefix + "_x_um", centre.x(), by.row(0));
  values.add(prefix + "_y_um", centre.y(), by.row(1));
  values.add(prefix + "_z_um", centre.z(), by.row(2));
}

/// `turn`: 1 or -1, so that the axis points into -90 < azimuth <= 90 degrees, or up where it stands upright.
void add_direction(Values& values, RoundKind kind, const RoundForm& form, double turn) {
  const Eigen::Vector3d axis = turn * form.a;
  Eigen::MatrixXd by = Eigen::MatrixXd::Zero(3, parameters_of(kind));
  by.col(3) = turn * form.e;
  by.col(4) = turn * form.n;
  const double cosine = std::hypot(axis.x(), axis.y());
  if (cosine > kSmallestCosine) {
    values.add("azimuth_deg", std::atan2(axis.y(), axis.x()) * kDegrees,
               (axis.x() * by.row(1) - axis.y() * by.row(0)) / (cosine * cosine) * kDegrees);
  }
  // d elevation = unit vector upwards at right angles to the axis, times d axis
  Eigen::RowVector3d up(0.0, 0.0, 1.0);
  if (cosine > kSmallestCosine)
    up = Eigen::RowVector3d(-axis.z() * axis.x(), -axis.z() * axis.y(), cosine * cosine) / cosine;
  values.add("elevation_deg", std::atan2(axis.z(), cosine) * kDegrees, up * by * kDegrees);
}

void add_taper(Values& values, const RoundForm& form, double turn) {
  const double taper_deg = turn * std::atan(form.radius_slope()) * kDegrees;
  Eigen::RowVectorXd by = Eigen::RowVectorXd::Zero(6);
  by[5] = kDegrees;
  values.add("taper_deg", taper_deg, by);
  if (std::abs(taper_deg) <= kSmallestTaper_deg) return;
  const Eigen::Vector3d apex = form.centre() - form.a / (std::abs(form.kappa) * form.radius_slope());
  values.add("apex_x_um", apex.x());
  values.add("apex_y_um", apex.y());
  values.add("apex_z_um", apex.z());
}

}  // namespace

std::vector<NamedValue> round_values(RoundKind kind, const RoundFit& fit, double kernel_width_px) {
  const RoundForm& form = fit.form;
  Values values(fit, kernel_width_px);
  Eigen::RowVectorXd by_kappa = Eigen::RowVectorXd::Zero(parameters_of(kind));
  by_kappa[2] = 1.0 / (form.kappa * form.kappa);
  values.add("radius_um", 1.0 / std::abs(form.kappa), by_kappa);
  if (kind == RoundKind::kSphere) {
    add_centre(values, kind, form, "centre");
    return values.values;
  }
  add_centre(values, kind, form, "axis");
  const bool upright = std::hypot(form.a.x(), form.a.y()) <= kSmallestCosine;
  const bool backwards = upright ? form.a.z() < 0.0 : form.a.x() < 0.0 || (form.a.x() == 0.0 && form.a.y() < 0.0);
  const double turn = backwards ? -1.0 : 1.0;
  add_direction(values, kind, form, turn);
  if (kind == RoundKind::kCone) add_taper(values, form, turn);
  return values.values;
}

}  // namespace fvd::metrology
