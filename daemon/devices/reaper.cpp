#include "daemon/devices/reaper.hpp"

#include <utility>

#include "core/runtime/guarded_thread.hpp"

namespace fvd {

Reaper::Reaper() : thread_(start_thread("fvd-reaper", [this](std::stop_token stop) { run(stop); })) {}

Reaper::~Reaper() = default;

void Reaper::enqueue(std::shared_ptr<void> device) {
  {
    const MutexLock lock(mutex_);
    dead_.push_back(std::move(device));
  }
  changed_.notify_one();
}

void Reaper::run(std::stop_token stop) {
  MutexLock lock(mutex_);
  for (;;) {
    changed_.wait(lock, stop, [this] {
      mutex_.assert_held();
      return !dead_.empty();
    });
    if (dead_.empty()) return;  // stop requested and nothing left
    auto device = std::move(dead_.front());
    dead_.pop_front();
    lock.unlock();
    device.reset();
    lock.lock();
  }
}

}  // namespace fvd
