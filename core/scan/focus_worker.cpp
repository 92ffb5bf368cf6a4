#include "core/scan/focus_worker.hpp"

#include <array>
#include <utility>
#include <vector>

#include <pthread.h>

namespace fvd {

FocusWorker::FocusWorker(StreamingFocusStack& stack, std::size_t queue_slices, Tap tap)
    : stack_(stack), queue_(queue_slices), tap_(std::move(tap)), thread_([this](std::stop_token stop) { run(stop); }) {
  pthread_setname_np(thread_.native_handle(), "fvd-focus");
}

bool FocusWorker::push(Slice&& slice, HostTime deadline, std::stop_token stop) {
  return queue_.push_until(std::move(slice), deadline, std::move(stop));
}

void FocusWorker::finish() {
  queue_.close();
  if (thread_.joinable()) thread_.join();
  if (failure_) std::rethrow_exception(failure_);
}

void FocusWorker::run(std::stop_token stop) {
  try {
    // What has come meanwhile is computed together: the further the computation is behind, the faster it gets.
    std::vector<Slice> batch;
    batch.reserve(StreamingFocusStack::kMaxBatch);
    while (auto slice = queue_.pop(stop)) {
      batch.clear();
      batch.push_back(std::move(*slice));
      while (batch.size() < StreamingFocusStack::kMaxBatch) {
        auto next = queue_.try_pop();
        if (!next) break;
        batch.push_back(std::move(*next));
      }
      consume(batch);
    }
  } catch (...) {
    failure_ = std::current_exception();
    queue_.close();  // the next push is refused and ends the scan; finish() then tells the reason
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
