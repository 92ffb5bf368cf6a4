#pragma once

/// Which neighbour distance and window suit a surface, from one sharp image of it.

#include "core/focus/measure/focus_settings.hpp"
#include "core/image/image.hpp"

namespace fvd {

struct FocusSuggestion {
  int distance_px = 2;
  int window_px = 9;
  double noise_grey = 0.0;     ///< standard deviation of a pixel, as far as one image tells it
  double response_grey = 0.0;  ///< mean modified Laplacian at that distance, less what noise makes of it
  double sample_noise = 0.0;   ///< noise of a sample over the peak with these settings
};

/// The mean modified Laplacian grows with the distance until it spans half a period of the texture, while that of noise
/// stays. Larger ones blur what is measured: taken is the least distance with half of the largest response, which is
/// where the generated stacks and the simulated surface are measured best. The window is the least odd one whose
/// noise is at most 1 % of the peak, within 5..31: noise falls with its side, lateral resolution too.
/// Throws Error kBadInput for an image below 32 x 32 pixels or one without texture above its noise.
[[nodiscard]] FocusSuggestion suggest_focus(const ImageView& sharp);

}  // namespace fvd
