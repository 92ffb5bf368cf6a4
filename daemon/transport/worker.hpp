#pragma once

/// One thread for calls that wait for files, the database or a lock, so that the network thread never does.

#include <deque>
#include <functional>
#include <stop_token>
#include <string>
#include <thread>

#include "core/base/mutex.hpp"

namespace fvd {

/// Runs tasks in the order in which they came. context: thread-safe.
class Worker {
 public:
  using Task = std::function<void()>;

  /// name: the thread's.
  explicit Worker(std::string name);
  /// Waits for the running task; tasks that have not begun are dropped.
  ~Worker();
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  /// The queue has no limit: each caller keeps at most one task in it.
  void post(Task task);

 private:
  void run(const std::stop_token& stop);

  const std::string name_;
  Mutex mutex_;
  Condition changed_;
  std::deque<Task> tasks_ FVD_GUARDED_BY(mutex_);
  std::jthread thread_;  // last
};

}  // namespace fvd
