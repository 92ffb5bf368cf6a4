#include "daemon/devices/reaper.hpp"

#include <utility>

#include "core/runtime/guarded_thread.hpp"

namespace fvd {

Reaper::Reaper() : thread_(start_thread("fvd-reaper", [this](std::stop_token stop) { run(stop); })) {}

Reaper::~Reaper() = default;

Closed Reaper::enqueue(std::shared_ptr<void> device) {
  auto closed = std::make_shared<std::atomic<bool>>(false);
  {
    const MutexLock lock(mutex_);
    given_up_.push_back({std::move(device), closed});
  }
  changed_.notify_one();
  return closed;
}

void Reaper::run(std::stop_token stop) {
  for (;;) {
    Burial burial;
    {
      MutexLock lock(mutex_);
      changed_.wait(lock, stop, [this] {
        mutex_.assert_held();
        return !given_up_.empty();
      });
      if (given_up_.empty()) return;  // stop was requested and nothing is left
      burial = std::move(given_up_.front());
      given_up_.pop_front();
    }
    burial.device.reset();
    *burial.closed = true;
  }
}

}  // namespace fvd
