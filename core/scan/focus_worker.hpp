#pragma once

/// The thread between camera and computation: takes slices off a bounded queue and feeds those that are believed to the
/// focus stack.

#include <exception>
#include <functional>
#include <span>
#include <stop_token>
#include <thread>
#include <vector>

#include "core/focus/drift_undo.hpp"
#include "core/focus/judge/slice_gate.hpp"
#include "core/focus/streaming_focus_stack.hpp"
#include "core/runtime/bounded_queue.hpp"
#include "core/scan/slice_sink.hpp"

namespace fvd {

/// context: push() from the scan's thread; finish() and what follows it from the thread that made the worker.
class FocusWorker final : public SliceSink {
 public:
  /// Called with every slice on the worker's thread before it is computed, e.g. to record it.
  using Tap = std::function<void(const ImageView& pixels, double z_um)>;

  /// Frames that the worker may hold back until those after them have come, beside the queue's.
  static constexpr int kHeldBack = SliceGate<Slice>::kHeldBack;

  /// queue_slices: how many slices the computation may fall behind, >= 1. allowed_lost_slices: so many that must not be
  /// believed are left out, one more is an error. drift: undone before slices are computed. The stack outlives the
  /// worker.
  FocusWorker(StreamingFocusStack& stack, std::size_t queue_slices, int allowed_lost_slices, Tap tap = {},
              DriftPath drift = {});
  /// Drops the slices that are still queued.
  ~FocusWorker() override = default;

  [[nodiscard]] bool push(Slice&& slice, HostTime deadline, std::stop_token stop) override;

  /// Waits until every pushed slice is computed. Rethrows the first error of the worker's thread: kBadSlice for one
  /// slice too many that must not be believed, and what the stack and the tap throw.
  void finish();

  /// After finish(): the slices that were left out.
  [[nodiscard]] const std::vector<SuspectSlice>& suspects() const noexcept { return gate_.suspects(); }
  /// After finish(): see SliceJudge.
  [[nodiscard]] double flicker_percent() const noexcept { return gate_.flicker_percent(); }
  /// After finish(): of the slices as they came, see DriftMeter.
  [[nodiscard]] const DriftMeter& drift() const noexcept { return drift_; }
  /// After finish(): what not every slice shows.
  [[nodiscard]] const HiddenBorder& hidden_border() const noexcept { return undo_.border(); }

 private:
  struct Believed {
    Slice slice;
    double gain;
  };
  void run(std::stop_token stop);
  void judge(std::vector<Slice>& batch);
  void consume();

  StreamingFocusStack& stack_;
  BoundedQueue<Slice> queue_;
  Tap tap_;
  SliceGate<Slice> gate_;
  DriftMeter drift_;
  DriftUndo undo_;
  std::vector<Believed> believed_;  // not yet computed; at most a batch
  std::exception_ptr failure_;      // written by the worker before it ends, read after join
  std::jthread thread_;             // last: everything above outlives it
};

}  // namespace fvd
