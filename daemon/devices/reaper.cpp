#include "daemon/devices/reaper.hpp"

#include <utility>

#include <pthread.h>

namespace fvd {

Reaper::Reaper() : thread_([this](std::stop_token stop) { run(stop); }) {
  pthread_setname_np(thread_.native_handle(), "fvd-reaper");
}

Reaper::~Reaper() = default;

void Reaper::enqueue(std::shared_ptr<void> device) {
  {
    const std::lock_guard lock(mutex_);
    dead_.push_back(std::move(device));
  }
  changed_.notify_one();
}

void Reaper::run(std::stop_token stop) {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, stop, [this] { return !dead_.empty(); });
    if (dead_.empty()) return;  // stop requested and nothing left
    auto device = std::move(dead_.front());
    dead_.pop_front();
    lock.unlock();
    device.reset();
    lock.lock();
  }
}

}  // namespace fvd
