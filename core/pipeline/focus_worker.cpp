#include "core/pipeline/focus_worker.hpp"

#include <utility>

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
    while (auto slice = queue_.pop(stop)) consume(*slice);
  } catch (...) {
    failure_ = std::current_exception();
    queue_.close();  // the next push is refused and ends the scan; finish() then tells the reason
  }
}

void FocusWorker::consume(const Slice& slice) {
  if (tap_) tap_(slice.frame.image, slice.z_um);
  stack_.push(slice.frame.image, slice.z_um);
}

}  // namespace fvd
