#pragma once

/// The scan: move, settle, expose, measure, hand on. Knows interfaces only.

#include <functional>
#include <optional>
#include <stop_token>
#include <vector>

#include "core/base/clock.hpp"
#include "core/focus/judge/slice_first_look.hpp"
#include "core/hw/axis.hpp"
#include "core/hw/camera.hpp"
#include "core/scan/frame_ledger.hpp"
#include "core/scan/scan_plan.hpp"
#include "core/scan/slice_capture.hpp"
#include "core/scan/slice_sink.hpp"
#include "core/stage/step_log.hpp"

namespace fvd {

/// Steps and frames of a scan, complete up to the moment at which it ended, also by an error.
struct ScanReport {
  StepLog steps;
  FrameCounts frames;
  std::vector<SuspectSlice> suspects;  ///< frames that were taken again, and slices that were left out during the scan
  int lost_slices = 0;                 ///< of the plan: without a good frame, or left out during the scan
  int ramp_frames = 0;  ///< frames of a continuous scan before its first slice and after its last; not in `frames`
};

struct ScanDependencies {
  Camera& camera;  ///< configured
  Axis& stage;     ///< homed
  Clock& clock;
  SliceSink& sink;
};

/// context: run() on one thread; stop requests from any thread.
class ScanRunner {
 public:
  explicit ScanRunner(const ScanDependencies& dependencies) : deps_(dependencies) {}

  /// Runs the plan from the take-up move to the last slice. `report` is kept up to date slice by slice, and
  /// `on_slice`, if set, is called after each, on this thread. On any error the stage is stopped before it is reported.
  /// Throws Error kStageLimit (before anything moves), kStageNotHomed, kCameraFramesLost, kBadSlice (slices that must
  /// not be believed, also when taken again), kSliceLost, kAborted, and
  /// what camera and stage throw.
  void run(const ScanPlan& plan, ScanReport& report, const std::function<void(const ScanReport&)>& on_slice,
           std::stop_token stop);

 private:
  void hand_over(Slice&& slice, int index, std::stop_token stop);
  [[nodiscard]] std::optional<CapturedFrame> capture_by_line(const ScanPlan& plan, Micrometers target, MoveRecord& move,
                                                             SliceCapture& capture, std::stop_token stop);
  [[nodiscard]] std::optional<CapturedFrame> capture_believed(const ScanPlan& plan, int index, HostTime settled,
                                                              SliceCapture& capture, ScanReport& report,
                                                              std::stop_token stop);
  void take_up(const ScanPlan& plan, std::stop_token stop);

  ScanDependencies deps_;
  SliceFirstLook look_;
};

}  // namespace fvd
