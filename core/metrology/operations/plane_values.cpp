#include "core/metrology/operations/plane_values.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/metrology/operations/bands.hpp"

namespace fvd::metrology {

void put_plane_first(OperationReport& report, const ChosenPoints& points, const Eigen::Vector3d& plane,
                     const Eigen::Matrix3d& covariance, double kernel_width_px) {
  Eigen::Matrix3d to_um = Eigen::Matrix3d::Zero();
  to_um(0, 0) = 1.0;
  to_um(0, 1) = -points.centre_x_um / points.half_x_um;
  to_um(0, 2) = -points.centre_y_um / points.half_y_um;
  to_um(1, 1) = 1.0 / points.half_x_um;
  to_um(2, 2) = 1.0 / points.half_y_um;
  const Eigen::Vector3d values = to_um * plane;
  const Eigen::Matrix3d variance = to_um * covariance * to_um.transpose();
  const auto value = [&](const char* name, int i) {
    return NamedValue{name, values[i], std::sqrt(std::max(variance(i, i), 0.0)) * kernel_width_px};
  };
  report.values.insert(report.values.begin(), {value("offset_um", 0), value("slope_x", 1), value("slope_y", 2)});
}

void subtract_plane(HeightField& field, const ChosenPoints& points, const Eigen::Vector3d& plane, WorkerPool* pool) {
  run_bands(pool, field.height(), [&](int, int first, int end) {
    for (int row = first; row < end; ++row) {
      const double base = plane[0] + plane[2] * ((field.y_um(row) - points.centre_y_um) / points.half_y_um);
      const double slope = plane[1] / points.half_x_um;
      double* z = field.z_um.row(row);
      for (int column = 0; column < field.width(); ++column) {
        z[column] -= base + slope * (field.x_um(column) - points.centre_x_um);
      }
    }
  });
}

}  // namespace fvd::metrology
