#pragma once

/// Neighbour distance and window for a surface, from one sharp image of it.

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

/// The mean modified Laplacian of texture grows with the distance until it spans half a period of the texture; that of
/// noise does not depend on the distance. Larger distances blur the measurement. The suggestion is the smallest
/// distance with half of the largest response, at which the generated stacks and the simulated surface have the
/// smallest error, and the smallest odd window within 5..31 whose noise is at most 1 % of the peak: noise and lateral
/// resolution both fall with the window's side. Throws Error kBadInput for an image below 32 x 32 pixels or one without
/// texture above its noise. context: pure.
[[nodiscard]] FocusSuggestion suggest_focus(const ImageView& sharp);

}  // namespace fvd
