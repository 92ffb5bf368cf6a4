#pragma once

/// Heights along a line across a surface.

#include <cstddef>
#include <functional>
#include <vector>

#include "core/metrology/height_field.hpp"

namespace fvd::metrology {

struct Profile {
  std::vector<double> z_um;  ///< equally spaced; NaN = hole
  double pitch_um = 1.0;     ///< > 0; point i stands at (i + 0.5) * pitch_um from the line's start

  [[nodiscard]] double length_um() const { return static_cast<double>(z_um.size()) * pitch_um; }
};

/// In the coordinates of the field (see HeightField).
struct ProfileLine {
  double from_x_um = 0.0;
  double from_y_um = 0.0;
  double to_x_um = 0.0;
  double to_y_um = 0.0;
  double band_width_um = 0.0;  ///< averaged across the line; below one pixel: the line alone
  /// A point of the profile is given where at least this share of its samples across the band is valid. A smaller share
  /// than all of them moves points of a surface that slopes across the line.
  double min_band_share = 1.0;
};

/// Mean over the band. Samples stand one pixel apart, along and across (the pitch in that direction; the spacing is
/// stretched so that whole numbers of them fill line and band), and are bilinear between the four points around them: a
/// neighbour of any weight that is missing makes the sample a hole. Own definition.
///
/// Throws Error(kBadInput) where the line has under two points or a number is not finite, Error(kRegionOutside) where
/// line or band leave the field. context: pure.
[[nodiscard]] Profile extract_profile(const HeightField& field, const ProfileLine& line);

/// A field whose points are somewhere else, such as in a file: a line needs few of them.
struct PointField {
  int width = 0;
  int height = 0;
  double pitch_x_um = 1.0;  ///< > 0
  double pitch_y_um = 1.0;  ///< > 0
  /// NaN = hole; asked for points of the field alone, some of them several times. What it throws is passed on.
  std::function<double(int column, int row)> z_um;
};

/// The same bit for bit.
[[nodiscard]] Profile extract_profile(const PointField& field, const ProfileLine& line);

}  // namespace fvd::metrology
