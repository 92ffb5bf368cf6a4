#pragma once

/// A scan in one motion: the stage passes the slices at constant speed, the camera runs free, and each frame's height
/// is where the stage was in the middle of its exposure.

#include <functional>
#include <stop_token>

#include "core/scan/free_run.hpp"
#include "core/scan/scan_runner.hpp"

namespace fvd {

/// Frames are accepted in order of arrival; a frame whose position is not known yet is kept while the next arrive.
/// Slices are the frames exposed from half a step before the first target to half a step after the last; all others
/// belong to the ramps. Lost slices are gaps in the frame ids between the first and the last slice, and places at which
/// no frame was exposed, except one at either end. Slices that lie evenly up to 5 % further apart than planned are no
/// loss; a camera that is up to 5 % faster than asked gives more slices than planned, over the same distance.
/// context: run() on one thread; stop requests from any thread. Another thread moves the stage meanwhile.
class ContinuousScan {
 public:
  /// The camera is configured already, with free_run.settings(). It runs free until free_run ends.
  ContinuousScan(const ScanDependencies& dependencies, FreeRun& free_run) : deps_(dependencies), free_run_(free_run) {}

  /// As ScanRunner::run. On every way out the stage is at rest, or stopped.
  /// Throws Error kBadRecipe and kStageLimit before anything moves, kStageNotHomed, kCameraFramesLost, kCameraSettings
  /// if the camera is much faster than asked, kSliceLost, kAborted, and what camera and stage throw.
  void run(const ScanPlan& plan, ScanReport& report, const std::function<void(const ScanReport&)>& on_slice,
           std::stop_token stop);

 private:
  ScanDependencies deps_;
  FreeRun& free_run_;
};

}  // namespace fvd
