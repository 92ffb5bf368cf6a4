#pragma once

/// Neighbour distance and window for a surface, from one sharp image of it.

#include <optional>

#include "core/focus/measure/focus_settings.hpp"
#include "core/image/image.hpp"

namespace fvd {

struct FocusSuggestion {
  int distance_px = 2;
  int window_px = 9;
  double noise_grey = 0.0;     ///< standard deviation of a pixel in grey levels, as estimated from one image
  double response_grey = 0.0;  ///< mean modified Laplacian at distance_px without the contribution of noise
  double sample_noise = 0.0;   ///< noise of a sample over the peak of the focus curve with these settings, 0..1
};

/// The default settings, unless the noise of a sample would exceed 3 % of the curves' peak with them: then noise is
/// most of the error of a height, and a larger window, or a neighbour farther away where the texture is coarse, lowers
/// it. Both cost lateral resolution, and on a slope accuracy, so no more of them is suggested than needed: the smallest
/// distance with half of the largest response, then the smallest odd window within 9..31 px with a noise below that
/// share.
///
/// noise_grey: standard deviation of a pixel, > 0; nothing = estimated in the image, where fine texture looks like
/// noise. Throws Error kBadInput for an image below 32 x 32 pixels or one without texture above its noise. context:
/// pure.
[[nodiscard]] FocusSuggestion suggest_focus(const ImageView& sharp, std::optional<double> noise_grey = std::nullopt);

}  // namespace fvd
