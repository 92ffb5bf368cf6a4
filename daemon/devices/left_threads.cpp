#include "daemon/devices/left_threads.hpp"

#include <atomic>
#include <chrono>
#include <exception>
#include <memory>
#include <utility>
#include <vector>

#include "core/base/clock.hpp"
#include "core/base/mutex.hpp"
#include "core/runtime/guarded_thread.hpp"

namespace fvd {

namespace {

/// How often a wait looks whether the process ends.
constexpr std::chrono::milliseconds kLook{50};

std::atomic<bool> is_ending{false};

/// Never destroyed: nobody waits for these.
struct LeftThreads {
  Mutex mutex;
  std::vector<std::jthread> threads FVD_GUARDED_BY(mutex);
};
LeftThreads& left() {
  static auto* const threads = new LeftThreads;
  return *threads;
}

/// What the thread and its caller share; the thread may outlive the caller.
struct Task {
  std::function<void()> work;
  Mutex mutex;
  Condition changed;
  bool done FVD_GUARDED_BY(mutex) = false;
  std::exception_ptr failure FVD_GUARDED_BY(mutex);
};

void run(Task& task) {
  std::exception_ptr failure;
  try {
    task.work();
  } catch (...) {
    failure = std::current_exception();
  }
  {
    const MutexLock lock(task.mutex);
    task.failure = failure;
    task.done = true;
  }
  task.changed.notify_all();
}

}  // namespace

void process_ends() noexcept { is_ending = true; }

bool process_is_ending() noexcept { return is_ending; }

void leave_thread(std::jthread thread) {
  const MutexLock lock(left().mutex);
  left().threads.push_back(std::move(thread));
}

bool left_a_thread() noexcept {
  const MutexLock lock(left().mutex);
  return !left().threads.empty();
}

bool run_unless_process_ends(std::string name, std::function<void()> work) {
  const auto task = std::make_shared<Task>();
  task->work = std::move(work);
  std::jthread thread = start_thread(std::move(name), [task](const std::stop_token&) { run(*task); });
  const auto done = [&task] {
    task->mutex.assert_held();
    return task->done;
  };
  MutexLock lock(task->mutex);
  while (!is_ending && !task->changed.wait_for(lock, kLook, done)) {
  }
  if (!task->changed.wait_for(lock, kLook, done)) {
    leave_thread(std::move(thread));
    return false;
  }
  if (task->failure) std::rethrow_exception(task->failure);
  return true;
}

}  // namespace fvd
