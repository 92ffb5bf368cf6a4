#include "core/scan/continuous_scan.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <sstream>
#include <thread>
#include <utility>

#include "core/base/error.hpp"
#include "core/runtime/guarded_thread.hpp"
#include "core/scan/reference.hpp"

namespace fvd {

namespace {

using std::chrono::milliseconds;

/// Longest wait for a frame before the state of the stage is checked.
constexpr milliseconds kFrameWait{20};
/// How much wider or closer than planned the slices may lie throughout: cameras keep a frame rate within 2 %, and a
/// drive rounds a low speed to whole units, by up to 3.2 %.
constexpr double kPaceTolerance = 0.05;
/// Number of steps by which the frames may lag behind the position before frames count as lost: half a step of phase,
/// and one that the ends may cost.
constexpr double kMaxFramesBehind = 1.5;
/// Give up if the slice queue stays full this long.
constexpr std::chrono::seconds kQueueTimeout{10};

HostTime middle(const Frame& frame) { return frame.exposure_start + (frame.exposure_end - frame.exposure_start) / 2; }

/// The stage's motion on a thread of its own; stopped and waited for when this goes.
class Sweep {
 public:
  Sweep(Axis& stage, Micrometers target, double speed_um_per_s, std::stop_token stop)
      : stage_(stage), forward_(stop, [this] { own_.request_stop(); }) {
    auto task = std::make_shared<std::packaged_task<void()>>(
        [this, target, speed_um_per_s] { stage_.sweep_to(target, speed_um_per_s, own_.get_token()); });
    result_ = task->get_future();
    thread_ = start_thread("fvd-sweep", [task](const std::stop_token& /*own_ stops it*/) { (*task)(); });
  }
  ~Sweep() { own_.request_stop(); }
  Sweep(const Sweep&) = delete;
  Sweep& operator=(const Sweep&) = delete;

  /// True once the stage is at rest at its end. Throws what ended the motion.
  [[nodiscard]] bool over() {
    if (!result_.valid()) return true;
    if (result_.wait_for(milliseconds(0)) != std::future_status::ready) return false;
    result_.get();
    return true;
  }

 private:
  Axis& stage_;
  std::stop_source own_;
  std::stop_callback<std::function<void()>> forward_;
  std::future<void> result_;
  std::jthread thread_;
};

/// Sorts frames into slices, ramps and losses. Positions grow along the way of the scan, whichever way that is.
class SliceSorter {
 public:
  SliceSorter(const ScanPlan& plan, FrameLedger& ledger) : plan_(plan), ledger_(ledger) {}

  enum class Place { kBefore, kSlice, kAfter };
  /// What was known when a good frame arrived.
  struct Circumstances {
    int incomplete = 0;           ///< damaged frames since the good one before
    std::uint64_t underruns = 0;  ///< of the camera so far
  };

  /// Where the frame belongs; books it, if it is a slice, and the frames between it and the one before.
  Place sort(std::uint64_t id, double z_um, Circumstances now) {
    const double way_um = along(z_um);
    const double step_um = plan_.step.value;
    const double end_um = (plan_.slices - 0.5) * step_um;
    const Place place = way_um < -0.5 * step_um        ? Place::kBefore
                        : way_um > end_um || covered() ? Place::kAfter
                                                       : Place::kSlice;
    const bool gap = !last_id_ || id > *last_id_ + 1;
    if (gap && place != Place::kBefore) {
      // Those of the gap that were slices: it may begin on the ramp before them and end on the one after.
      const bool began_inside = last_id_ && last_way_um_ >= -0.5 * step_um;
      const bool ends_inside = way_um <= end_um;
      const double room = (std::min(way_um, end_um) - (began_inside ? last_way_um_ : -0.5 * step_um)) / step_um;
      const double skipped = last_id_ ? static_cast<double>(id - *last_id_ - 1) : std::max(0.0, std::floor(room));
      book_lost(static_cast<int>(began_inside && ends_inside ? skipped : std::clamp(std::floor(room), 0.0, skipped)),
                now);
    }
    if (place != Place::kBefore) book_missed_places(way_um, place == Place::kAfter, !gap, now);
    underruns_ = now.underruns;
    last_id_ = id;
    last_way_um_ = way_um;
    if (place == Place::kSlice) {
      ledger_.ok();
      ++taken_;
    }
    return place;
  }

  /// No frame came after the last slice.
  void close(Circumstances now) {
    if (covered()) return;
    book_lost(
        full() ? static_cast<int>((last_target_um() - last_way_um_) / plan_.step.value) : plan_.slices - taken_ - lost_,
        now);
  }

  [[nodiscard]] int taken() const { return taken_; }
  [[nodiscard]] int lost() const { return lost_; }
  /// More slices than a camera that is a little faster than asked takes on the whole way.
  [[nodiscard]] bool far_too_many() const {
    return taken_ + lost_ > plan_.slices * (1.0 + kPaceTolerance) + kMaxFramesBehind;
  }
  /// How far the slices reach, from the first target on.
  [[nodiscard]] double reach_um() const { return last_way_um_; }
  /// Position along the way, from the first target on.
  [[nodiscard]] double along(double z_um) const {
    return plan_.downwards ? plan_.highest().value - z_um : z_um - plan_.start.value;
  }

 private:
  [[nodiscard]] double last_target_um() const { return (plan_.slices - 1) * plan_.step.value; }
  /// Slices and losses together are as many as were planned.
  [[nodiscard]] bool full() const { return taken_ + lost_ >= plan_.slices; }
  /// And they reach the end: a camera that is faster than asked takes more than were planned on the same way.
  [[nodiscard]] bool covered() const { return full() && last_way_um_ >= last_target_um() - plan_.step.value; }
  /// The camera is faster than asked, by so much that more slices than planned may come.
  [[nodiscard]] bool ahead() const { return taken_ + lost_ - 1 - last_way_um_ / plan_.step.value > kMaxFramesBehind; }

  /// A camera that exposes too seldom counts on without a gap: what it left out shows in the positions alone. One frame
  /// more or less at the ends is no loss, as frames lie anywhere between two targets; nor are slices evenly a little
  /// wider apart, which cover the range all the same: `slices` of the result tells planned and measured.
  void book_missed_places(double way_um, bool after, bool ids_follow, Circumstances now) {
    const double step_um = plan_.step.value;
    const bool began_inside = last_id_ && last_way_um_ >= -0.5 * step_um;
    int missed = 0;
    if (ids_follow && began_inside && way_um - last_way_um_ >= 1.5 * step_um) {
      const double leap = (std::min(way_um, last_target_um() + step_um) - last_way_um_) / step_um;
      missed = std::max(0, static_cast<int>(std::lround(leap)) - 1);
    }
    const int open = plan_.slices - taken_ - lost_;
    if (after) {
      const bool fall_short = open - missed > std::max(1.0, kPaceTolerance * plan_.slices);
      if (!ahead() && (fall_short || places_missed_ + missed > 0)) missed = open;
    } else {
      const double behind = way_um / step_um - (taken_ + lost_ + missed);  // -0.5..0.5 if every frame came
      const double allowed =
          places_missed_ > 0 ? kMaxFramesBehind : std::max(kMaxFramesBehind, kPaceTolerance * way_um / step_um);
      if (behind >= allowed) missed += static_cast<int>(behind);
      if (!ahead()) missed = std::min(missed, open - 1);  // this frame is a slice
    }
    if (missed <= 0) return;
    places_missed_ += missed;
    book_lost(missed, now);
  }

  void book_lost(int count, Circumstances now) {
    for (int i = 0; i < count; ++i) {
      if (now.incomplete > 0) {
        --now.incomplete;
        ledger_.incomplete();
      } else if (now.underruns > underruns_) {
        ledger_.underrun();
      } else {
        ledger_.missing();
      }
      ++lost_;
    }
  }

  const ScanPlan& plan_;
  FrameLedger& ledger_;
  std::optional<std::uint64_t> last_id_;
  double last_way_um_ = 0.0;
  std::uint64_t underruns_ = 0;
  int taken_ = 0;
  int lost_ = 0;
  int places_missed_ = 0;  // of the lost: those that no gap in the ids shows
};

Error too_many_lost(const SliceSorter& sorter, const ScanPlan& plan, const FrameCounts& frames) {
  std::ostringstream message;
  message << sorter.lost() << " of " << plan.slices << " slices were lost in the motion (" << frames.missing
          << " missing, " << frames.incomplete << " incomplete, " << frames.underrun
          << " for want of a buffer), the recipe allows " << plan.allowed_lost_slices
          << ": check the camera's link and frame rate, use a lower scan.speed_um_per_s, or scan.mode step";
  return {ErrorCode::kCameraFramesLost, message.str()};
}

Error camera_too_fast(const SliceSorter& sorter, const ScanPlan& plan) {
  std::ostringstream message;
  message << "the camera is faster than asked: " << sorter.taken() << " slices were taken on the first "
          << sorter.reach_um() << " um of the way, " << plan.slices << " were to cover all "
          << (plan.slices - 1) * plan.step.value << " um of it: check whether the camera keeps the frame rate of "
          << plan.frame_rate_hz() << " Hz, or use scan.mode step";
  return {ErrorCode::kCameraSettings, message.str()};
}

void require_frames_as_planned(const SliceSorter& sorter, const ScanPlan& plan, const FrameCounts& frames) {
  if (sorter.lost() > plan.allowed_lost_slices) throw too_many_lost(sorter, plan, frames);
  if (sorter.far_too_many()) throw camera_too_fast(sorter, plan);
}

StepRecord record(int index, const Frame& frame, const PositionMean& position) {
  StepRecord step;
  step.index = index;
  // Nobody commanded the stage to be just there: its position is not judged by the plan's.
  step.commanded_um = step.quantised_um = step.measured_um = position.mean.value;
  step.measured_sd_um = position.sd.value;
  step.position_samples = position.samples;
  step.frame_id = frame.id;
  step.triggers = 0;
  step.exposure_start = frame.exposure_start;
  return step;
}

/// Where the stage was then. A stop request ends the wait for it.
PositionMean position_at(const ScanDependencies& deps, HostTime moment, const std::stop_token& stop) {
  deps.clock.wait_until(moment + kPositionReach, stop);
  if (stop.stop_requested()) throw Error(ErrorCode::kAborted, "the scan was stopped");
  return deps.stage.position_at(moment, kPositionReach);
}

}  // namespace

void ContinuousScan::run(const ScanPlan& plan, ScanReport& report,
                         const std::function<void(const ScanReport&)>& on_slice, std::stop_token stop) {
  const StageInfo stage = deps_.stage.info();
  check_continuous(plan, free_run_.settings(), stage);
  check_plan(plan, stage);
  if (!has_reference(deps_.stage, deps_.clock)) {
    throw Error(ErrorCode::kStageNotHomed, "the stage has no reference: home it before the scan");
  }
  FrameLedger ledger;
  SliceSorter sorter(plan, ledger);
  const Micrometers before = run_up(plan, stage);
  const Micrometers after_last = run_out(plan, stage);
  const Micrometers low = plan.start - (plan.downwards ? after_last : before);
  const Micrometers high = plan.highest() + (plan.downwards ? before : after_last);
  const std::stop_callback wake(stop, [this] { deps_.camera.interrupt(); });
  report.steps.reserve(static_cast<std::size_t>(plan.slices));
  struct Waiting {
    Frame frame;
    HostTime moment;  // middle of the exposure on the stage's clock
    SliceSorter::Circumstances circumstances;
  };
  try {
    SettleCriterion wide = plan.settle;
    wide.window = std::max(plan.settle.window, before * 0.5);
    deps_.stage.move_to(plan.downwards ? high : low, wide, stop);
    free_run_.begin(plan.frame_rate_hz());
    Sweep sweep(deps_.stage, plan.downwards ? low : high, plan.speed_um_per_s, stop);
    std::deque<Waiting> waiting;  // gone before the camera is configured anew
    SliceSorter::Circumstances circumstances;
    bool after = false;
    std::optional<HostTime> at_rest;
    while (!after || !at_rest) {
      if (stop.stop_requested()) throw Error(ErrorCode::kAborted, "the scan was stopped");
      if (auto frame = deps_.camera.next_frame(deps_.clock.now() + kFrameWait)) {
        if (after) {
          ++report.ramp_frames;
        } else if (frame->status == FrameStatus::kOk) {
          const HostTime moment = middle(*frame) + plan.time_offset;
          circumstances.underruns = deps_.camera.health().underruns;
          waiting.push_back({std::move(*frame), moment, std::exchange(circumstances, {})});
        } else {
          ++circumstances.incomplete;
        }
      }
      if (!at_rest && sweep.over()) at_rest = deps_.clock.now();
      // All that are left are waited for once the stage is at rest and no frame can be on its way any more.
      const bool last = at_rest && deps_.clock.now() > *at_rest + deps_.camera.frame_deadline();
      while (!waiting.empty() && !after) {
        Waiting& oldest = waiting.front();
        if (!last && deps_.clock.now() < oldest.moment + kPositionReach) break;
        const PositionMean position = position_at(deps_, oldest.moment, stop);
        const auto place = sorter.sort(oldest.frame.id, position.mean.value, oldest.circumstances);
        report.frames = ledger.counts();
        require_frames_as_planned(sorter, plan, report.frames);
        if (place == SliceSorter::Place::kSlice) {
          report.steps.push_back(record(sorter.taken() + sorter.lost() - 1, oldest.frame, position));
          if (!deps_.sink.push({std::move(oldest.frame), position.mean.value, report.steps.back().index},
                               deps_.clock.now() + kQueueTimeout, stop)) {
            if (stop.stop_requested()) throw Error(ErrorCode::kAborted, "the scan was stopped");
            throw Error(ErrorCode::kSliceLost,
                        "a slice found no room in the slice queue: the computation hangs or is far too slow; use more "
                        "threads, a smaller window or a lower scan.speed_um_per_s");
          }
          if (on_slice) on_slice(report);
        } else {
          ++report.ramp_frames;
          after = place == SliceSorter::Place::kAfter;
        }
        waiting.pop_front();
      }
      if (after) {
        report.ramp_frames += static_cast<int>(waiting.size());
        waiting.clear();
      }
      if (last) break;
    }
    circumstances.underruns = deps_.camera.health().underruns;
    if (!after) sorter.close(circumstances);
    report.frames = ledger.counts();
    require_frames_as_planned(sorter, plan, report.frames);
  } catch (...) {
    report.frames = ledger.counts();
    deps_.stage.stop();
    throw;
  }
}

}  // namespace fvd
