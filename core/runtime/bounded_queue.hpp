#pragma once

/// A queue between two threads with a fixed number of places.

#include <cassert>
#include <chrono>
#include <cstddef>
#include <optional>
#include <stop_token>
#include <utility>
#include <vector>

#include "core/base/mutex.hpp"

namespace fvd {

/// First in, first out; never grows. context: thread-safe.
template <typename T>
class BoundedQueue {
 public:
  explicit BoundedQueue(std::size_t capacity) : ring_(capacity) { assert(capacity > 0); }

  /// Waits for room. False, and `item` untouched, if there is no room by the deadline, the queue is closed or stop is
  /// requested; the caller decides what a loss means.
  template <typename Clock>
  [[nodiscard]] bool push_until(T&& item, std::chrono::time_point<Clock> deadline, std::stop_token stop) {
    MutexLock lock(mutex_);
    changed_.wait_until(lock, stop, deadline, [this] {
      mutex_.assert_held();
      return count_ < ring_.size() || closed_;
    });
    if (stop.stop_requested() || closed_ || count_ == ring_.size()) return false;
    ring_[(first_ + count_) % ring_.size()] = std::move(item);
    ++count_;
    changed_.notify_all();
    return true;
  }

  /// Waits for an item. Returns nothing once the queue is closed and empty, or as soon as stop is requested.
  [[nodiscard]] std::optional<T> pop(std::stop_token stop) {
    MutexLock lock(mutex_);
    changed_.wait(lock, stop, [this] {
      mutex_.assert_held();
      return count_ > 0 || closed_;
    });
    if (count_ == 0 || stop.stop_requested()) return std::nullopt;
    return pop_locked();
  }

  /// An item that is there already, without waiting.
  [[nodiscard]] std::optional<T> try_pop() {
    const MutexLock lock(mutex_);
    if (count_ == 0) return std::nullopt;
    return pop_locked();
  }

  /// No more items come; what is inside can still be popped.
  void close() {
    {
      const MutexLock lock(mutex_);
      closed_ = true;
    }
    changed_.notify_all();
  }

 private:
  std::optional<T> pop_locked() FVD_REQUIRES(mutex_) {
    std::optional<T> item(std::move(*ring_[first_]));
    ring_[first_].reset();
    first_ = (first_ + 1) % ring_.size();
    --count_;
    changed_.notify_all();
    return item;
  }

  Mutex mutex_;
  Condition changed_;
  std::vector<std::optional<T>> ring_ FVD_GUARDED_BY(mutex_);
  std::size_t first_ FVD_GUARDED_BY(mutex_) = 0;
  std::size_t count_ FVD_GUARDED_BY(mutex_) = 0;
  bool closed_ FVD_GUARDED_BY(mutex_) = false;
};

}  // namespace fvd
