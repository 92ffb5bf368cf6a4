#pragma once

/// Finds the height at which a region is sharpest: a coarse scan, a finer one around its maximum, a parabola.

#include <stop_token>
#include <vector>

#include "core/base/clock.hpp"
#include "core/hw/axis.hpp"
#include "core/hw/camera.hpp"

namespace fvd {

/// Part of an image, pixels.
struct Region {
  int x = 0;
  int y = 0;
  int width = 0;
  int height = 0;
};
/// The middle half of an image on both sides.
[[nodiscard]] Region central_region(int width, int height);

/// Mean modified Laplacian |2I - I(x-1) - I(x+1)| + |2I - I(y-1) - I(y+1)| over the region, in grey levels (Nayar and
/// Nakagawa, IEEE PAMI 16(8), 1994). The region's inner pixels only; it is cut to the image.
[[nodiscard]] double mean_focus(const ImageView& image, const Region& region);

struct AutofocusPlan {
  Micrometers from;
  Micrometers to;          ///< > from
  Micrometers step{10.0};  ///< step of the coarse scan, > 0; that of the fine scan is a quarter of it
  int frame_retries = 3;   ///< further triggers for a frame that was lost, >= 0
  SettleCriterion settle;
};

/// Throws Error kBadInput, kStageLimit as autofocus() does before anything moves. context: pure.
void check_plan(const AutofocusPlan& plan, const StageInfo& stage);

struct FocusSample {
  double z_um = 0.0;   ///< measured
  double focus = 0.0;  ///< mean_focus() of the central region, grey levels
};

struct AutofocusResult {
  double z_um = 0.0;               ///< height at which the region is sharpest; the stage stands there
  double focus = 0.0;              ///< largest measured value of the fine scan, grey levels
  std::vector<FocusSample> curve;  ///< samples of both scans, in ascending order of z
};

/// Finds the height at which the central region is sharpest and moves the stage there. The camera must be configured
/// and triggered by software, the stage homed. Every move arrives from below. Throws Error kBadInput for a range of
/// less than 3 or more than 1000 steps, kStageLimit before anything moves, kStageNotHomed, kCameraFramesLost,
/// kFocusRange if the sharpest sample lies at an end of the range or is less than 5 % above the lowest, kAborted, and
/// what camera and stage throw. context: the scan's thread.
[[nodiscard]] AutofocusResult autofocus(Camera& camera, Axis& stage, Clock& clock, const AutofocusPlan& plan,
                                        std::stop_token stop);

}  // namespace fvd
