#include "core/scan/focus_worker.hpp"

#include <array>
#include <utility>
#include <vector>

#include "core/runtime/guarded_thread.hpp"
#include "core/runtime/thread_ticks.hpp"

namespace fvd {

namespace {

/// A batch takes milliseconds; its slices may be written to a disk that is slow (Tap).
constexpr std::chrono::seconds kLongestBatch{60};

}  // namespace

FocusWorker::FocusWorker(StreamingFocusStack& stack, std::size_t queue_slices, Tap tap)
    : stack_(stack),
      queue_(queue_slices),
      tap_(std::move(tap)),
      thread_(start_thread(
          "fvd-focus", [this](std::stop_token stop) { run(stop); },
          [this](std::string_view /*name*/, const std::exception_ptr& failure) {
            failure_ = failure;
            queue_.close();  // the next push is refused and ends the scan; finish() tells the reason
          })) {}

bool FocusWorker::push(Slice&& slice, HostTime deadline, std::stop_token stop) {
  return queue_.push_until(std::move(slice), deadline, std::move(stop));
}

void FocusWorker::finish() {
  queue_.close();
  if (thread_.joinable()) thread_.join();
  if (failure_) std::rethrow_exception(failure_);
}

void FocusWorker::run(std::stop_token stop) {
  ThreadTicks ticks("fvd-focus", kLongestBatch);
  // What has come meanwhile is computed together: the further the computation is behind, the faster it gets.
  std::vector<Slice> batch;
  batch.reserve(StreamingFocusStack::kMaxBatch);
  while (auto slice = queue_.pop(stop)) {
    ticks.tick(HostClock::now());
    batch.clear();
    batch.push_back(std::move(*slice));
    while (batch.size() < StreamingFocusStack::kMaxBatch) {
      auto next = queue_.try_pop();
      if (!next) break;
      batch.push_back(std::move(*next));
    }
    consume(batch);
    ticks.rest();
  }
}

void FocusWorker::consume(std::span<const Slice> batch) {
  std::array<ZSlice, StreamingFocusStack::kMaxBatch> slices;
  for (std::size_t k = 0; k < batch.size(); ++k) {
    if (tap_) tap_(batch[k].frame.image, batch[k].z_um);
    slices[k] = {batch[k].frame.image, batch[k].z_um};
  }
  stack_.push(std::span(slices).first(batch.size()));
}

}  // namespace fvd
