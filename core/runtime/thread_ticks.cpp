#include "core/runtime/thread_ticks.hpp"

#include <utility>

#include "core/base/mutex.hpp"

namespace fvd {

namespace {

/// Made at its first use, so that no thread's ticks come before it.
struct Registry {
  Mutex mutex;
  std::vector<const ThreadTicks*> threads FVD_GUARDED_BY(mutex);

  static Registry& instance() {
    static Registry registry;
    return registry;
  }
};

}  // namespace

ThreadTicks::ThreadTicks(std::string name, std::chrono::milliseconds allowed)
    : name_(std::move(name)), longest_(allowed) {
  Registry& registry = Registry::instance();
  const MutexLock lock(registry.mutex);
  registry.threads.push_back(this);
}

ThreadTicks::~ThreadTicks() {
  Registry& registry = Registry::instance();
  const MutexLock lock(registry.mutex);
  std::erase(registry.threads, this);
}

HostClock::duration ThreadTicks::age(HostTime now) const noexcept {
  const HostTime last = last_;
  return last == kResting || last > now ? HostClock::duration::zero() : now - last;
}

std::vector<StalledThread> stalled_threads(HostTime now) {
  Registry& registry = Registry::instance();
  const MutexLock lock(registry.mutex);
  std::vector<StalledThread> stalled;
  for (const ThreadTicks* thread : registry.threads) {
    const auto allowed = thread->allowed();  // before its age, see tick()
    const auto age = thread->age(now);
    if (age <= allowed) continue;
    stalled.push_back({thread->name(), std::chrono::duration_cast<std::chrono::milliseconds>(age), allowed});
  }
  return stalled;
}

}  // namespace fvd
