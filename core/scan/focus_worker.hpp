#pragma once

/// The thread between camera and computation: takes slices off a bounded queue and feeds them to the focus stack.

#include <exception>
#include <functional>
#include <span>
#include <stop_token>
#include <thread>

#include "core/focus/streaming_focus_stack.hpp"
#include "core/runtime/bounded_queue.hpp"
#include "core/scan/slice_sink.hpp"

namespace fvd {

/// context: push() from the scan's thread; finish() from the thread that made the worker.
class FocusWorker final : public SliceSink {
 public:
  /// Called with every slice on the worker's thread before it is computed, e.g. to record it.
  using Tap = std::function<void(const ImageView& pixels, double z_um)>;

  /// queue_slices: how many slices the computation may fall behind, >= 1. The stack outlives the worker.
  FocusWorker(StreamingFocusStack& stack, std::size_t queue_slices, Tap tap = {});
  /// Drops the slices that are still queued.
  ~FocusWorker() override = default;

  [[nodiscard]] bool push(Slice&& slice, HostTime deadline, std::stop_token stop) override;

  /// Waits until every pushed slice is computed. Rethrows the first error of the worker's thread.
  void finish();

 private:
  void run(std::stop_token stop);
  void consume(std::span<const Slice> batch);

  StreamingFocusStack& stack_;
  BoundedQueue<Slice> queue_;
  Tap tap_;
  std::exception_ptr failure_;  // written by the worker before it ends, read after join
  std::jthread thread_;         // last: everything above outlives it
};

}  // namespace fvd
