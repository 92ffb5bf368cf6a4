#pragma once

/// The weights of a focus window as the metrology of surfaces takes them.

#include "core/focus/measure/focus_settings.hpp"
#include "core/surface/lateral_kernel.hpp"

namespace fvd {

/// Of the window alone: what the operator's neighbours and a smoothing add is not in it. context: pure.
[[nodiscard]] LateralKernel window_kernel(const FocusSettings& settings);

}  // namespace fvd
