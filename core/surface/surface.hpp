#pragma once

/// A surface as a file or a reconstruction gives it and as evaluation and export take it.

#include <optional>
#include <string>

#include "core/image/image.hpp"
#include "core/surface/lateral_kernel.hpp"
#include "core/surface/mask_reason.hpp"

namespace fvd {

/// Heights on a regular grid: column 0 left, row 0 on top. They are float32 metres, as reconstruction makes them, so
/// that a surface from a file and the surface of the job that wrote the file are the same bit for bit. Moves are cheap;
/// copies are explicit through clone().
struct Surface {
  Plane<float> height_m;    ///< [height][width]; NaN = hole, never an infinity
  Plane<float> sigma_m;     ///< standard error of a height; of the same shape, NaN in a hole; empty = not known
  Plane<MaskReasons> mask;  ///< why a point is a hole, 0 = valid; of the same shape; empty = not known
  double pitch_x_um = 0.0;  ///< distance of columns, > 0 and finite
  double pitch_y_um = 0.0;  ///< distance of rows, > 0 and finite
  LateralKernel kernel;     ///< what the focus window did to the points; {1} where it is not known
  std::optional<double> lateral_period_um;  ///< period that the map shows at half its amplitude; absent = not known
  std::string title;                        ///< for people: the part or the file's own title; may be empty

  [[nodiscard]] int width() const noexcept { return height_m.width(); }
  [[nodiscard]] int height() const noexcept { return height_m.height(); }
  [[nodiscard]] bool has_sigma() const noexcept { return !sigma_m.empty(); }
  [[nodiscard]] bool has_mask() const noexcept { return !mask.empty(); }
  [[nodiscard]] Surface clone() const {
    return {height_m.clone(), sigma_m.clone(), mask.clone(), pitch_x_um, pitch_y_um, kernel, lateral_period_um, title};
  }
};

}  // namespace fvd
