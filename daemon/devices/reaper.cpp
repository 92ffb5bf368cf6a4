#include "daemon/devices/reaper.hpp"

#include <chrono>
#include <utility>

#include "core/base/clock.hpp"
#include "core/runtime/guarded_thread.hpp"
#include "core/runtime/thread_ticks.hpp"
#include "daemon/devices/left_threads.hpp"

namespace fvd {

namespace {

/// A device that was lost takes its timeouts one after the other.
constexpr std::chrono::minutes kLongestClosing{5};

}  // namespace

Reaper::Reaper(std::string name, std::chrono::milliseconds last_wait)
    : last_wait_(last_wait),
      thread_(start_thread(name, [name, work = work_](const std::stop_token& stop) { run(name, *work, stop); })) {}

Reaper::~Reaper() {
  thread_.request_stop();
  if (!process_is_ending()) return;  // the thread's own destructor waits
  bool ended = false;
  {
    MutexLock lock(work_->mutex);
    ended = work_->changed.wait_until(lock, HostClock::now() + last_wait_, [this] {
      work_->mutex.assert_held();
      return work_->ended;
    });
  }
  if (!ended) leave_thread(std::move(thread_));
}

Closed Reaper::enqueue(std::shared_ptr<void> device) {
  auto closed = std::make_shared<std::atomic<bool>>(false);
  {
    const MutexLock lock(work_->mutex);
    work_->given_up.push_back({std::move(device), closed});
  }
  work_->changed.notify_all();
  return closed;
}

void Reaper::run(const std::string& name, Work& work, const std::stop_token& stop) {
  ThreadTicks ticks(name, kLongestClosing);
  for (;;) {
    ticks.rest();
    Burial burial;
    {
      MutexLock lock(work.mutex);
      work.changed.wait(lock, stop, [&work] {
        work.mutex.assert_held();
        return !work.given_up.empty();
      });
      if (work.given_up.empty()) {  // stop was requested and nothing is left
        work.ended = true;
        work.changed.notify_all();
        return;
      }
      burial = std::move(work.given_up.front());
      work.given_up.pop_front();
    }
    ticks.tick(HostClock::now());
    burial.device.reset();
    *burial.closed = true;
  }
}

}  // namespace fvd
