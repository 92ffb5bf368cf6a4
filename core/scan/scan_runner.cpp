#include "core/scan/scan_runner.hpp"

#include <algorithm>
#include <sstream>
#include <utility>

#include "core/base/error.hpp"
#include "core/scan/approach.hpp"
#include "core/scan/reference.hpp"
#include "core/scan/slice_capture.hpp"

namespace fvd {

namespace {

/// The stage stands still while the computation catches up: nothing is lost by waiting, only time.
constexpr std::chrono::seconds kQueueTimeout{10};

double milliseconds(HostClock::duration duration) {
  return std::chrono::duration<double, std::milli>(duration).count();
}

StepRecord record_move(int index, Micrometers target, const MoveRecord& move) {
  StepRecord step;
  step.index = index;
  step.commanded_um = target.value;
  step.quantised_um = move.target_quantised.value;
  step.commanded_counts = move.target_counts.value;
  step.move_ms = milliseconds(move.settled - move.started);
  step.settle_polls = move.polls;
  return step;
}

void record_exposure(StepRecord& step, const CapturedFrame& captured, const PositionMean& position) {
  step.measured_um = position.mean.value;
  step.measured_sd_um = position.sd.value;
  step.position_samples = position.samples;
  step.error_um = step.measured_um - step.quantised_um;
  step.frame_id = captured.frame.id;
  step.triggers = captured.triggers;
  step.exposure_start = captured.frame.exposure_start;
}

/// Where the stage has passed before the target.
Micrometers before(const ScanPlan& plan, Micrometers target, Micrometers distance) {
  return plan.downwards ? target + distance : target - distance;
}

Error too_many_lost(int index, Micrometers target, const ScanPlan& plan, const ScanReport& report,
                    const SliceCapture& capture) {
  std::ostringstream message;
  const int lost = report.lost_slices;
  if (!report.suspects.empty() && report.suspects.back().index == index &&
      report.suspects.back().done == SuspectDone::kLeftOut) {
    message << suspect_text(report.suspects.back()) << ", in " << 1 + plan.frame_retries << " frames; " << lost
            << " slice(s) lost, the recipe allows " << plan.allowed_lost_slices
            << ": check light, exposure and the camera's link";
    return {ErrorCode::kBadSlice, message.str()};
  }
  message << "slice " << index << " at " << target.value << " um, " << lost << " slice(s) lost, the recipe allows "
          << plan.allowed_lost_slices << ": no good frame";
  if (!plan.line_trigger) return capture.failure(message.str());
  message << " within " << 1 + plan.frame_retries
          << " arrivals: check the trigger line, the camera's link and its packet counters";
  return {ErrorCode::kCameraFramesLost, message.str()};
}

}  // namespace

void ScanRunner::take_up(const ScanPlan& plan, std::stop_token stop) {
  const Micrometers distance = deps_.stage.info().take_up;
  if (distance.value <= 0) return;
  // The move below the first slice (above it, of a scan downwards) only has to end there: an axis with backlash comes
  // to rest outside the window that slices are held to when it arrives from the other side.
  SettleCriterion wide = plan.settle;
  wide.window = std::max(plan.settle.window, distance * 0.5);
  deps_.stage.move_to(before(plan, plan.target(0), distance), wide, stop);
}

void ScanRunner::hand_over(Slice&& slice, int index, std::stop_token stop) {
  if (deps_.sink.push(std::move(slice), deps_.clock.now() + kQueueTimeout, stop)) return;
  if (stop.stop_requested()) throw Error(ErrorCode::kAborted, "the scan was stopped");
  throw Error(ErrorCode::kSliceLost,
              "slice " + std::to_string(index) + " found no room in the slice queue within " +
                  std::to_string(kQueueTimeout / std::chrono::seconds(1)) +
                  " s: the computation hangs or is far too slow; use more threads or a smaller window");
}

std::optional<CapturedFrame> ScanRunner::capture_by_line(const ScanPlan& plan, Micrometers target, MoveRecord& move,
                                                         SliceCapture& capture, std::stop_token stop) {
  // The drive says "in position" before the stage has settled: what counts is where it stood during the exposure.
  const auto at_target = [&](const Frame& frame) {
    const PositionMean position = deps_.stage.mean_position(frame.exposure_start, frame.exposure_end);
    return frame.exposure_start >= move.started && abs(position.mean - move.target_quantised) <= plan.settle.window;
  };
  for (int attempt = 0;; ++attempt) {
    if (auto captured = capture.await_line(at_target, stop)) {
      captured->triggers = 1 + attempt;
      return captured;
    }
    if (attempt == plan.frame_retries) return std::nullopt;
    // Only another arrival makes another edge.
    SettleCriterion wide = plan.settle;
    const Micrometers away = approach(plan, deps_.stage.info());
    wide.window = std::max(plan.settle.window, away * 0.5);
    deps_.stage.move_to(before(plan, target, away), wide, stop);
    move = deps_.stage.move_to(target, plan.settle, stop);
  }
}

/// A frame that is dark, constant, delivered in part or a repetition is taken again: the stage still stands there.
std::optional<CapturedFrame> ScanRunner::capture_believed(const ScanPlan& plan, int index, HostTime settled,
                                                          SliceCapture& capture, ScanReport& report,
                                                          std::stop_token stop) {
  int triggers = 0;
  for (int attempt = 0;; ++attempt) {
    auto captured = capture.capture(settled, plan.frame_retries, stop);
    if (!captured) return captured;
    triggers = captured->triggers += triggers;
    const bool comes_again = attempt < plan.frame_retries;
    auto suspect = look_.doubt(captured->frame.image, index, plan.target(index).value, comes_again);
    if (!suspect) {
      const auto withdrawn = [index](const SuspectSlice& slice) {
        return slice.index == index && slice.reason == SuspectReason::kDark;
      };
      if (look_.withdrew()) std::erase_if(report.suspects, withdrawn);
      return captured;
    }
    suspect->done = comes_again ? SuspectDone::kTakenAgain : SuspectDone::kLeftOut;
    report.suspects.push_back(*suspect);
    if (!comes_again) return std::nullopt;
  }
}

void ScanRunner::run(const ScanPlan& plan, ScanReport& report, const std::function<void(const ScanReport&)>& on_slice,
                     std::stop_token stop) {
  check_plan(plan, deps_.stage.info());
  if (!has_reference(deps_.stage, deps_.clock)) {
    throw Error(ErrorCode::kStageNotHomed, "the stage has no reference: home it before the scan");
  }
  // With no feedback the position is not observable; the commanded one is all there is.
  const bool measured_z = deps_.stage.info().feedback != FeedbackSource::kNone;
  FrameLedger ledger;
  SliceCapture capture(deps_.camera, deps_.clock, ledger);
  const std::stop_callback wake(stop, [this] { deps_.camera.interrupt(); });
  report.steps.reserve(static_cast<std::size_t>(plan.slices));
  look_ = {};
  try {
    take_up(plan, stop);
    for (int index = 0; index < plan.slices; ++index) {
      const Micrometers target = plan.target(index);
      MoveRecord move = deps_.stage.move_to(target, plan.settle, stop);
      auto captured = plan.line_trigger ? capture_by_line(plan, target, move, capture, stop)
                                        : capture_believed(plan, index, move.settled, capture, report, stop);
      StepRecord step = record_move(index, target, move);
      report.frames = ledger.counts();
      if (!captured) {
        for (SuspectSlice& slice : report.suspects) {
          if (slice.index == index) slice.done = SuspectDone::kLeftOut;
        }
        if (++report.lost_slices > plan.allowed_lost_slices) throw too_many_lost(index, target, plan, report, capture);
        step.measured = false;
        step.triggers = 1 + plan.frame_retries;
      } else {
        // The trigger came after the stage had settled; an exposure that seems to begin before is the clock map's
        // error.
        const Frame& frame = captured->frame;
        const HostTime from = plan.line_trigger ? frame.exposure_start : std::max(frame.exposure_start, move.settled);
        record_exposure(step, *captured, deps_.stage.mean_position(from, std::max(from, frame.exposure_end)));
        const double z_um = measured_z ? step.measured_um : step.quantised_um;
        hand_over({std::move(captured->frame), z_um, index}, index, stop);
      }
      report.steps.push_back(step);
      if (on_slice) on_slice(report);
    }
  } catch (...) {
    report.frames = ledger.counts();
    deps_.stage.stop();
    throw;
  }
}

}  // namespace fvd
