#pragma once

/// Where the slices of a scan lie, how many may be lost, and the checks of both before anything moves.

#include <chrono>

#include "core/base/units.hpp"
#include "core/hw/axis.hpp"
#include "core/hw/camera.hpp"

namespace fvd {

enum class ScanMode {
  kStep,        ///< the stage stops for every slice
  kContinuous,  ///< the stage moves on at constant speed while the camera runs free
};

struct ScanPlan {
  ScanMode mode = ScanMode::kStep;
  Micrometers start;       ///< target of the lowest slice
  Micrometers step{10.0};  ///< > 0: the scan goes one way only, so that backlash stays loaded
  int slices = 0;          ///< >= 1
  SettleCriterion settle;
  int frame_retries = 3;        ///< further triggers for a slice whose frame was lost
  int allowed_lost_slices = 0;  ///< a scan that loses more slices fails

  bool line_trigger = false;  ///< kStep: the drive's in-position output triggers the camera

  double speed_um_per_s = 0.0;               ///< kContinuous: > 0
  double max_blur_steps = 0.5;               ///< kContinuous: largest travel during one exposure, in steps
  bool downwards = false;                    ///< from the highest slice to the lowest
  std::chrono::microseconds time_offset{0};  ///< kContinuous: of the stage's clock against the camera's, see LagResult

  /// kContinuous: frames per second at which the slices lie one step apart.
  [[nodiscard]] double frame_rate_hz() const { return speed_um_per_s / step.value; }

  /// In the order of the scan.
  [[nodiscard]] Micrometers target(int index) const {
    return start + static_cast<double>(downwards ? slices - 1 - index : index) * step;
  }
  [[nodiscard]] Micrometers highest() const { return start + static_cast<double>(slices - 1) * step; }
};

/// Run-up distance before the first slice of a continuous scan: the axis is at constant speed there, the backlash
/// loaded, and its position known from samples on both sides.
[[nodiscard]] Micrometers run_up(const ScanPlan& plan, const StageInfo& stage);
/// Run-out distance after its last slice, likewise.
[[nodiscard]] Micrometers run_out(const ScanPlan& plan, const StageInfo& stage);

/// Reach of Axis::position_at() in a continuous scan: half the width of its window of samples.
inline constexpr std::chrono::microseconds kPositionReach{10000};

/// Throws Error kBadRecipe if a continuous scan would blur its slices or is faster than camera or stage, or if the
/// stage does not measure its position. settings: those in force, or those of the recipe before the camera is
/// configured.
void check_continuous(const ScanPlan& plan, const CameraSettings& settings, const StageInfo& stage);

/// Throws Error kStageLimit, with the values and the range, if the scan or its take-up move would leave the limits.
void check_plan(const ScanPlan& plan, const StageInfo& stage);

}  // namespace fvd
