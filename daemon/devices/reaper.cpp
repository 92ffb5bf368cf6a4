#include "daemon/devices/reaper.hpp"

#include <utility>

#include "core/runtime/guarded_thread.hpp"

namespace fvd {

Reaper::Reaper() : thread_(start_thread("fvd-reaper", [this](std::stop_token stop) { run(stop); })) {}

Reaper::~Reaper() = default;

void Reaper::enqueue(std::shared_ptr<void> device) {
  {
    const MutexLock lock(mutex_);
    given_up_.push_back(std::move(device));
  }
  changed_.notify_one();
}

void Reaper::run(std::stop_token stop) {
  for (;;) {
    std::shared_ptr<void> device;
    {
      MutexLock lock(mutex_);
      changed_.wait(lock, stop, [this] {
        mutex_.assert_held();
        return !given_up_.empty();
      });
      if (given_up_.empty()) return;  // stop was requested and nothing is left
      device = std::move(given_up_.front());
      given_up_.pop_front();
    }
    device.reset();
  }
}

}  // namespace fvd
