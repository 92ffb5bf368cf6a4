#include "daemon/pipeline/measurement.hpp"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "core/base/error.hpp"
#include "core/focus/streaming_focus_stack.hpp"
#include "core/scan/continuous_scan.hpp"
#include "core/scan/reference.hpp"
#include "daemon/pipeline/reconstruct.hpp"
#include "daemon/pipeline/scan_average.hpp"

namespace fvd {

namespace {

double milliseconds_since(const Clock& clock, HostTime start) {
  return std::chrono::duration<double, std::milli>(clock.now() - start).count();
}

std::string describe(const CameraInfo& camera, const StageInfo& stage) {
  return camera_text(camera) + "; " + stage.name + " at " + stage.address;
}

void copy_books(const ScanReport& report, ResultData& result) {
  result.steps = report.steps;
  result.frames = report.frames;
  result.ramp_frames = report.ramp_frames;
  result.step_summary = summarize_steps(report.steps);
  result.suspects = report.suspects;
}

/// What the scans of a job add up to. A scan fills the result as if it were the only one; carry() keeps its books
/// before the next begins, settle() puts the sums in their place.
class ScanBooks {
 public:
  explicit ScanBooks(int scans) : scans_(scans) {}

  [[nodiscard]] bool is_last() const noexcept { return ended_ + 1 == scans_; }
  [[nodiscard]] SliceProgress progress(const ScanReport& report) const {
    return {slices_ + static_cast<int>(report.steps.size()), sum(frames_, report.frames)};
  }
  void carry(ResultData& result) {
    ++ended_;
    slices_ += static_cast<int>(result.steps.size());
    for (const StepRecord& step : result.steps) measured_ += step.measured ? 1 : 0;
    frames_ = sum(frames_, result.frames);
    ramp_frames_ += result.ramp_frames;
    flicker_percent_ = std::max(flicker_percent_, result.flicker_percent);
    suspects_.insert(suspects_.end(), result.suspects.begin(), result.suspects.end());
  }
  /// After the last scan, which was not carried.
  void settle(ResultData& result) {
    result.slices_measured_before = measured_;
    result.frames = sum(frames_, result.frames);
    result.ramp_frames += ramp_frames_;
    result.flicker_percent = std::max(flicker_percent_, result.flicker_percent);
    result.suspects_before = std::move(suspects_);
  }

 private:
  [[nodiscard]] static FrameCounts sum(const FrameCounts& a, const FrameCounts& b) {
    return {a.expected + b.expected, a.ok + b.ok,       a.incomplete + b.incomplete,
            a.missing + b.missing,   a.stale + b.stale, a.underrun + b.underrun};
  }

  int scans_;
  int ended_ = 0;
  int slices_ = 0;
  int measured_ = 0;
  int ramp_frames_ = 0;
  double flicker_percent_ = 0.0;
  FrameCounts frames_;
  std::vector<SuspectSlice> suspects_;
};

/// Runs the scan into the stack. What broke the focus thread is the reason to report, not the push it then refused.
void acquire(const ScanPlan& plan, const CameraSettings& settings, const MeasurementDependencies& deps,
             const MeasurementObserver& observer, const ScanBooks& books, StreamingFocusStack& stack, DriftPath drift,
             ResultData& result, std::stop_token stop) {
  FreeRun free_run(deps.camera, settings);  // ends after the worker, which holds frames
  FocusWorker worker(stack, deps.queue_slices, plan.allowed_lost_slices, observer.tap, std::move(drift));
  const ScanDependencies scan{deps.camera, deps.stage, deps.clock, worker};
  ScanReport report;
  const auto on_slice = [&](const ScanReport& so_far) { observer.on_slice(books.progress(so_far)); };
  try {
    if (plan.mode == ScanMode::kContinuous) {
      ContinuousScan(scan, free_run).run(plan, report, on_slice, stop);
    } else {
      ScanRunner(scan).run(plan, report, on_slice, stop);
    }
  } catch (const Error& error) {
    copy_books(report, result);
    on_slice(report);                                            // the books as they ended
    if (error.code() == ErrorCode::kSliceLost) worker.finish();  // which says why
    throw;
  }
  copy_books(report, result);
  if (books.is_last()) {
    observer.on_acquired();
    observer.on_phase("computing");
  }
  worker.finish();
  note_light(worker.suspects(), worker.flicker_percent(), result);
  note_drift(worker.drift(), worker.hidden_border(), result);
  if (report.lost_slices + static_cast<int>(worker.suspects().size()) > plan.allowed_lost_slices &&
      !worker.suspects().empty()) {
    std::vector<SuspectSlice> left_out = result.suspects;
    std::erase_if(left_out, [](const SuspectSlice& slice) { return slice.done != SuspectDone::kLeftOut; });
    throw_suspects(left_out, plan.allowed_lost_slices);
  }
}

/// A camera that answers nothing, or exposes for seconds, does not hold up a stop.
CameraSettings configure(Camera& camera, const CameraSettings& settings, const std::stop_token& stop) {
  const std::stop_callback wake(stop, [&camera] { camera.interrupt(); });
  // configure() cancels what was asked of the camera before, also by this stop.
  if (stop.stop_requested()) throw Error(ErrorCode::kAborted, "stopped before the camera was set up");
  return camera.configure(settings);
}

}  // namespace

ScanPlan scan_plan(const Recipe& recipe) {
  ScanPlan plan;
  plan.start = Micrometers{recipe.start_um};
  plan.step = Micrometers{recipe.step_um};
  plan.downwards = recipe.downwards;
  plan.slices = recipe.slices;
  plan.settle = recipe.settle;
  plan.frame_retries = recipe.frame_retries;
  plan.allowed_lost_slices = recipe.allowed_lost_slices;
  plan.mode = recipe.mode;
  plan.line_trigger = recipe.camera.trigger == TriggerMode::kLine;
  plan.speed_um_per_s = recipe.speed_um_per_s;
  plan.max_blur_steps = recipe.max_blur_steps;
  return plan;
}

void measure(const Recipe& recipe, const MeasurementDependencies& deps, const MeasurementObserver& observer,
             ResultData& result, std::stop_token stop) {
  const HostTime started = deps.clock.now();
  observer.on_phase("preparing");
  const CameraInfo camera = deps.camera.info();
  const StageInfo stage = deps.stage.info();
  result.source = describe(camera, stage);
  result.simulated = result.simulated || camera.simulated || stage.simulated;
  result.slices_planned = recipe.slices * recipe.repeat;
  if (stage.feedback_resolution.value > 0.0) result.encoder_resolution_um = stage.feedback_resolution.value;
  result.scan_mode = recipe.mode;
  result.speed_um_per_s = recipe.mode == ScanMode::kContinuous ? recipe.speed_um_per_s : 0.0;
  const CameraSettings settings = configure(deps.camera, recipe.camera, stop);
  if (settings.exposure_us > 0.0) result.exposure_us = settings.exposure_us;
  std::optional<StreamingFocusStack> stack;
  const auto renew_stack = [&] {
    stack.reset();  // its memory first
    stack.emplace(settings.width, settings.height, settings.slice_format(), focus_settings(recipe), deps.pool, false,
                  deps.pages);
  };
  renew_stack();
  std::optional<ScanAverage> average;
  if (recipe.repeat > 1) average.emplace(settings.width, settings.height);
  if (!has_reference(deps.stage, deps.clock)) deps.stage.home(stop);
  result.times.prepare_ms = milliseconds_since(deps.clock, started);

  observer.on_phase("acquiring");
  const HostTime scan_started = deps.clock.now();
  MeasurementObserver timed = observer;
  HostTime acquired{};
  HostTime told{};  // which may wait for the stage's rest
  timed.on_acquired = [&] {
    acquired = deps.clock.now();
    observer.on_acquired();
    told = deps.clock.now();
  };
  ScanPlan plan = scan_plan(recipe);
  plan.time_offset = deps.time_offset;
  const double middle_um = recipe.start_um + recipe.step_um * (recipe.slices / 2);
  ScanBooks books(recipe.repeat);
  while (!books.is_last()) {
    acquire(plan, settings, deps, timed, books, *stack, recipe_drift(recipe, middle_um), result, stop);
    const std::size_t warnings = result.warnings.size();
    reconstruct(*stack, recipe, result);
    result.warnings.resize(warnings);  // the last scan has them too
    average->add(result.map);
    books.carry(result);
    if (observer.on_earlier_scan) observer.on_earlier_scan(result.steps);
    result.map = {};
    renew_stack();
  }
  acquire(plan, settings, deps, timed, books, *stack, recipe_drift(recipe, middle_um), result, stop);
  result.times.scan_ms = std::chrono::duration<double, std::milli>(acquired - scan_started).count();
  reconstruct(*stack, recipe, result);
  if (average) {
    average->add(result.map);
    result.repeated = average->finish(result.map);
    if (auto warning = scatter_warning(*result.repeated, result.map)) result.warnings.push_back(*std::move(warning));
    average.reset();
  }
  books.settle(result);
  result.times.finish_ms = milliseconds_since(deps.clock, told);
  reconstruct_further(*stack, recipe, deps.pool, result);
  if (observer.on_maps) observer.on_maps();
  evaluate_as_asked(recipe, deps.pool, result, deps.pages);
}

}  // namespace fvd
