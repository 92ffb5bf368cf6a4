#pragma once

/// A surface where it is, without a copy.

#include <optional>

#include "core/image/image.hpp"
#include "core/surface/lateral_kernel.hpp"
#include "core/surface/mask_reason.hpp"
#include "core/surface/surface.hpp"

namespace fvd {

/// A surface whose planes belong to somebody else, who outlives it.
struct SurfaceRef {
  PlaneView<const float> height_m;
  PlaneView<const float> sigma_m;     ///< no data = not known
  PlaneView<const MaskReasons> mask;  ///< no data = not known
  double pitch_x_um = 0.0;
  double pitch_y_um = 0.0;
  LateralKernel kernel;
  std::optional<double> lateral_period_um;

  SurfaceRef() = default;
  SurfaceRef(const Surface& surface)  // NOLINT(google-explicit-constructor): a surface is one that is kept elsewhere
      : height_m(surface.height_m.view()),
        sigma_m(surface.sigma_m.view()),
        mask(surface.mask.view()),
        pitch_x_um(surface.pitch_x_um),
        pitch_y_um(surface.pitch_y_um),
        kernel(surface.kernel),
        lateral_period_um(surface.lateral_period_um) {}

  [[nodiscard]] bool has_sigma() const noexcept { return sigma_m.data != nullptr; }
  [[nodiscard]] bool has_mask() const noexcept { return mask.data != nullptr; }
};

}  // namespace fvd
