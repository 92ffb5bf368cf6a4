#pragma once

/// A surface as pictures show it.

#include <optional>
#include <string>

#include "core/surface/surface.hpp"

namespace fvd {

/// Owns no points. All planes have the same shape, or no data where they are not known.
struct PictureSurface {
  PlaneView<const float> height_m;  ///< metres, NaN = hole
  PlaneView<const float> sigma_m;
  PlaneView<const MaskReasons> mask;
  std::optional<double> pitch_x_um;  ///< both absent: axes count pixels
  std::optional<double> pitch_y_um;
  std::string title;  ///< for people
  bool simulated = false;

  [[nodiscard]] bool is_metric() const { return pitch_x_um && pitch_y_um; }
  [[nodiscard]] double pitch_x() const { return is_metric() ? *pitch_x_um : 1.0; }
  [[nodiscard]] double pitch_y() const { return is_metric() ? *pitch_y_um : 1.0; }
  /// Of the whole field; in pixels where the pitch is not known.
  [[nodiscard]] double width_um() const { return height_m.width * pitch_x(); }
  [[nodiscard]] double height_um() const { return height_m.height * pitch_y(); }
  [[nodiscard]] const char* lateral_unit() const { return is_metric() ? "µm" : "px"; }
};

[[nodiscard]] inline PictureSurface picture_surface(const Surface& surface) {
  PictureSurface picture;
  picture.height_m = surface.height_m.view();
  if (surface.has_sigma()) picture.sigma_m = surface.sigma_m.view();
  if (surface.has_mask()) picture.mask = surface.mask.view();
  picture.pitch_x_um = surface.pitch_x_um;
  picture.pitch_y_um = surface.pitch_y_um;
  picture.title = surface.title;
  return picture;
}

}  // namespace fvd
