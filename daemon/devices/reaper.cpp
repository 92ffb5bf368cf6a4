#include "daemon/devices/reaper.hpp"

#include <chrono>
#include <utility>
#include <vector>

#include "core/base/clock.hpp"
#include "core/runtime/guarded_thread.hpp"

namespace fvd {

namespace {

constexpr std::chrono::milliseconds kLastWait{200};

std::atomic<bool> process_is_ending{false};

/// Threads that are left running until the process ends. Never destroyed: nobody waits for them.
struct LeftThreads {
  Mutex mutex;
  std::vector<std::jthread> threads FVD_GUARDED_BY(mutex);
};
LeftThreads& left() {
  static auto* const threads = new LeftThreads;
  return *threads;
}

}  // namespace

void Reaper::process_ends() noexcept { process_is_ending = true; }

bool Reaper::left_a_device() noexcept {
  const MutexLock lock(left().mutex);
  return !left().threads.empty();
}

Reaper::Reaper()
    : thread_(start_thread("fvd-reaper", [work = work_](const std::stop_token& stop) { run(*work, stop); })) {}

Reaper::~Reaper() {
  thread_.request_stop();
  if (!process_is_ending) return;  // the thread's own destructor waits
  bool ended = false;
  {
    MutexLock lock(work_->mutex);
    ended = work_->changed.wait_until(lock, HostClock::now() + kLastWait, [this] {
      work_->mutex.assert_held();
      return work_->ended;
    });
  }
  if (ended) return;
  const MutexLock lock(left().mutex);
  left().threads.push_back(std::move(thread_));
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

void Reaper::run(Work& work, const std::stop_token& stop) {
  for (;;) {
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
    burial.device.reset();
    *burial.closed = true;
  }
}

}  // namespace fvd
