#pragma once

/// Probing errors and slope limit from the cap of a sphere of known radius.

#include <optional>
#include <vector>

#include "core/metrology/height_field.hpp"
#include "core/metrology/operations/region.hpp"
#include "core/metrology/study/noise_study.hpp"

namespace fvd::metrology {

struct SphereSettings {
  double radius_um = 0.0;        ///< calibrated, > 0
  bool bowl = false;             ///< the surface is the inner side
  double points_percent = 99.7;  ///< share of points that the form error is the range of, 50 < p <= 100
  double ring_deg = 1.0;         ///< width of a ring of slopes, 0.1 to 10
};

struct SlopeRing {
  double from_deg = 0.0;  ///< angle of the surface's normal from z
  double to_deg = 0.0;
  int points = 0;  ///< of the region, by the place in the image
  int valid = 0;   ///< of these, measured and on the sphere
};

struct SphereProbe {
  double radius_um = 0.0;  ///< of the sphere fitted to all points on it, least squares of the distances
  double u_radius_um = 0.0;
  double centre_x_um = 0.0;
  double centre_y_um = 0.0;
  double centre_z_um = 0.0;
  double form_error_um = 0.0;  ///< P_F: range of the distances from the fitted sphere of points_percent of the points
  double form_error_all_um = 0.0;  ///< the same of all points on the sphere
  double size_error_um = 0.0;      ///< P_S: fitted diameter - calibrated diameter
  double sd_um = 0.0;              ///< standard deviation of the distances
  int points = 0;                  ///< on the sphere
  double points_percent = 0.0;
  double max_slope_deg = 0.0;  ///< end of the steepest ring of which the region has enough points
  /// End of the steepest ring with at least half of its points valid. Equal to max_slope_deg where the field ends
  /// before the instrument's limit. Absent where no ring has.
  std::optional<double> slope_limit_deg;
  std::vector<SlopeRing> rings;  ///< from the top outwards, those with at least 20 points
};

/// VDI/VDE 2634-2:2012, probing error: form P_F (with its share of points stated) and size P_S. Points farther from
/// the sphere than six robust standard deviations are not on it: a base beside a cap, outliers. They count as not
/// measured for the slope limit, which is an own definition. A base meets a cap's rim within that distance: where the
/// cap ends inside of the field, a region that ends before the rim keeps the base out.
/// Refused: no cap of about that radius (0.5 to 2 times) by the majority of the points, under 100 points. Throws
/// Error(kBadInput) for settings out of range. context: pure.
[[nodiscard]] StudyOutcome<SphereProbe> sphere_probe(const HeightField& field, const SphereSettings& settings,
                                                     const Region& region = {});

}  // namespace fvd::metrology
