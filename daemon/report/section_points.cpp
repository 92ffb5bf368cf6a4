#include "daemon/report/section_points.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/units.hpp"

namespace fvd {

namespace {

constexpr int kMostAlong = 2000;
constexpr int kMostAcross = 400;

/// NaN for holes and outside.
double height_um(const PictureSurface& surface, double x_um, double y_um) {
  const double column = std::floor(x_um / surface.pitch_x());
  const double row = std::floor(y_um / surface.pitch_y());
  const bool inside = column >= 0.0 && row >= 0.0 && column < surface.height_m.width && row < surface.height_m.height;
  if (!inside) return std::numeric_limits<double>::quiet_NaN();
  return static_cast<double>(surface.height_m.at(static_cast<int>(column), static_cast<int>(row))) /
         kMetresPerMicrometer;
}

int steps(double length_um, double pitch_um, int most) {
  return static_cast<int>(std::clamp(std::round(length_um / pitch_um), 1.0, static_cast<double>(most)));
}

}  // namespace

std::vector<SectionPoint> section_points(const PictureSurface& surface, const CrossSection& section) {
  const double length_um = section.length_um();
  const double pitch_um = std::min(surface.pitch_x(), surface.pitch_y());
  const double along_x = (section.to_x_um - section.from_x_um) / length_um;
  const double along_y = (section.to_y_um - section.from_y_um) / length_um;
  const int count = steps(length_um, pitch_um, kMostAlong);
  const int across = steps(section.band_width_um, pitch_um, kMostAcross);
  std::vector<SectionPoint> points;
  points.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    const double along_um = (i + 0.5) / count * length_um;
    double sum_um = 0.0;
    int valid = 0;
    for (int k = 0; k < across; ++k) {
      const double beside_um = ((k + 0.5) / across - 0.5) * section.band_width_um;
      const double z_um = height_um(surface, section.from_x_um + along_x * along_um - along_y * beside_um,
                                    section.from_y_um + along_y * along_um + along_x * beside_um);
      if (std::isnan(z_um)) continue;
      sum_um += z_um;
      ++valid;
    }
    points.push_back({along_um, 2 * valid < across ? std::numeric_limits<double>::quiet_NaN() : sum_um / valid});
  }
  return points;
}

}  // namespace fvd
