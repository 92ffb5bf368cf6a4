#pragma once

/// Heights along a line of a surface, for pictures.

#include <vector>

#include "daemon/report/picture_surface.hpp"
#include "daemon/result/cross_section.hpp"

namespace fvd {

struct SectionPoint {
  double along_um = 0.0;
  double height_um = 0.0;  ///< NaN where under half of the points across the band are valid, or it leaves the field
};

/// One point a pixel's pitch: the mean of the valid points that lie nearest to those across the band. Nothing is
/// interpolated; a picture, not a measurement.
[[nodiscard]] std::vector<SectionPoint> section_points(const PictureSurface& surface, const CrossSection& section);

}  // namespace fvd
