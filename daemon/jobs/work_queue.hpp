#pragma once

/// What waits for the machine's thread: at most one command and one job, in the order in which they were taken.

#include <chrono>
#include <deque>
#include <functional>
#include <optional>
#include <stop_token>

#include "core/base/mutex.hpp"

namespace fvd {

/// One of the two is called, once. Neither throws.
struct Work {
  std::function<void()> run;     ///< on the machine's thread
  std::function<void()> refuse;  ///< in its place if the queue was closed before; on the thread that closes it
};

/// context: thread-safe.
class WorkQueue {
 public:
  /// False if the queue is closed: nothing of the work was called then, the caller refuses it.
  [[nodiscard]] bool post(Work work);
  /// The next work, or nothing when the time is over or a stop is requested.
  [[nodiscard]] std::optional<Work> take(std::stop_token stop, std::chrono::milliseconds patience);
  /// Refuses what waits; takes nothing more. May be repeated.
  void close();

 private:
  Mutex mutex_;
  Condition changed_;
  std::deque<Work> waiting_ FVD_GUARDED_BY(mutex_);
  bool closed_ FVD_GUARDED_BY(mutex_) = false;
};

}  // namespace fvd
