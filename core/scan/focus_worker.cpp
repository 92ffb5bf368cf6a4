#include "core/scan/focus_worker.hpp"

#include <utility>
#include <vector>

#include "core/runtime/guarded_thread.hpp"
#include "core/runtime/thread_ticks.hpp"

namespace fvd {

namespace {

/// A batch takes milliseconds; its slices may be written to a disk that is slow (Tap).
constexpr std::chrono::seconds kLongestBatch{60};

}  // namespace

FocusWorker::FocusWorker(StreamingFocusStack& stack, std::size_t queue_slices, int allowed_lost_slices, Tap tap,
                         DriftPath drift)
    : stack_(stack),
      queue_(queue_slices),
      tap_(std::move(tap)),
      gate_(allowed_lost_slices),
      undo_(std::move(drift)),
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
  believed_.reserve(StreamingFocusStack::kMaxBatch);
  while (auto slice = queue_.pop(stop)) {
    ticks.tick(HostClock::now());
    batch.clear();
    batch.push_back(std::move(*slice));
    while (batch.size() < StreamingFocusStack::kMaxBatch) {
      auto next = queue_.try_pop();
      if (!next) break;
      batch.push_back(std::move(*next));
    }
    judge(batch);
    consume();
    ticks.rest();
  }
  if (stop.stop_requested()) return;
  ticks.tick(HostClock::now());
  gate_.finish([this](Slice&& slice, double /*z_um*/, double gain) { believed_.push_back({std::move(slice), gain}); });
  consume();
}

void FocusWorker::judge(std::vector<Slice>& batch) {
  const auto pass = [this](Slice&& slice, double /*z_um*/, double gain) {
    believed_.push_back({std::move(slice), gain});
  };
  for (Slice& slice : batch) {
    const ImageView pixels = slice.frame.image;
    const int index = slice.index;
    const double z_um = slice.z_um;
    if (tap_) tap_(pixels, z_um);
    gate_.push(std::move(slice), pixels, slice_figures(pixels), index, z_um, pass);
  }
}

void FocusWorker::consume() {
  std::vector<ZSlice> slices;
  slices.reserve(believed_.size());
  for (const Believed& believed : believed_) {
    drift_.add(slice_patches(believed.slice.frame.image), believed.slice.z_um);
    slices.push_back({believed.slice.frame.image, believed.slice.z_um, nullptr, believed.gain});
  }
  undo_.apply(slices);
  stack_.push(slices);
  believed_.clear();
}

}  // namespace fvd
