#pragma once

/// One measurement from the recipe to the height maps, on devices that are open.

#include <chrono>
#include <cstddef>
#include <functional>
#include <stop_token>
#include <string_view>

#include "core/base/clock.hpp"
#include "core/hw/axis.hpp"
#include "core/hw/camera.hpp"
#include "core/runtime/worker_pool.hpp"
#include "core/scan/focus_worker.hpp"
#include "core/scan/scan_plan.hpp"
#include "core/scan/scan_runner.hpp"
#include "daemon/recipes/recipe.hpp"
#include "daemon/result/result_data.hpp"

namespace fvd {

[[nodiscard]] ScanPlan scan_plan(const Recipe& recipe);

struct MeasurementDependencies {
  Camera& camera;
  Axis& stage;
  Clock& clock;
  WorkerPool& pool;
  KeptPagesPtr pages;  ///< for the stack and its maps; may be null
  std::size_t queue_slices;
  std::chrono::microseconds time_offset{0};  ///< of the stage's clock against the camera's
};

/// How far a job is.
struct SliceProgress {
  int slices = 0;      ///< of all scans, those that were lost too
  FrameCounts frames;  ///< likewise
};

/// What the caller wants to hear while it runs; each is called on the measurement's thread.
struct MeasurementObserver {
  std::function<void(std::string_view phase)> on_phase;  ///< "preparing", "acquiring", "computing"
  std::function<void(const SliceProgress& progress)> on_slice;
  /// The steps of a scan after which the job takes another; the last scan's are in the result. May be empty.
  std::function<void(const StepLog& steps)> on_earlier_scan = {};
  std::function<void()> on_acquired;  ///< all slices are taken
  FocusWorker::Tap tap;               ///< every slice, on the focus thread; may be empty
  /// The result is there but for its evaluation: of it only `evaluation` and `times` change from now on. May be empty.
  std::function<void()> on_maps = {};
};

/// Configures the camera, homes the stage if it has no reference, scans recipe.repeat times, and computes. Fills of the
/// result what it measured: maps, steps, frames, times, source, simulated; `result` holds steps and frames even when it
/// throws. Of several scans `result` has the mean map, the frames and suspect slices of all, and all else of the last.
/// Throws what camera, stage and scan throw.
void measure(const Recipe& recipe, const MeasurementDependencies& dependencies, const MeasurementObserver& observer,
             ResultData& result, std::stop_token stop);

}  // namespace fvd
