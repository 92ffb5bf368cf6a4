#pragma once

/// Mutex, lock and condition variable that clang's thread-safety analysis understands; the standard library's carry no
/// annotations.
///
///   Mutex mutex_;
///   Condition changed_;
///   int count_ FVD_GUARDED_BY(mutex_) = 0;
///
///   MutexLock lock(mutex_);
///   changed_.wait(lock, stop, [this] { mutex_.assert_held(); return count_ > 0; });

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <stop_token>
#include <utility>

#include "core/base/thread_annotations.hpp"

namespace fvd {

class FVD_CAPABILITY("mutex") Mutex {
 public:
  Mutex() = default;
  Mutex(const Mutex&) = delete;
  Mutex& operator=(const Mutex&) = delete;

  void lock() FVD_ACQUIRE() { mutex_.lock(); }
  void unlock() FVD_RELEASE() { mutex_.unlock(); }
  [[nodiscard]] bool try_lock() FVD_TRY_ACQUIRE(true) { return mutex_.try_lock(); }

  /// Tells the analysis, which does not follow a lambda to its caller, that the mutex is held. Checks nothing.
  void assert_held() const FVD_ASSERT_CAPABILITY(this) {}

 private:
  std::mutex mutex_;
};

/// Holds a mutex for as long as it lives; may let go of it in between.
class FVD_SCOPED_CAPABILITY MutexLock {
 public:
  explicit MutexLock(Mutex& mutex) FVD_ACQUIRE(mutex) : mutex_(mutex) { mutex_.lock(); }
  ~MutexLock() FVD_RELEASE() {
    if (held_) mutex_.unlock();
  }
  MutexLock(const MutexLock&) = delete;
  MutexLock& operator=(const MutexLock&) = delete;

  void lock() FVD_ACQUIRE() {
    mutex_.lock();
    held_ = true;
  }
  void unlock() FVD_RELEASE() {
    held_ = false;
    mutex_.unlock();
  }

 private:
  Mutex& mutex_;
  bool held_ = true;
};

/// A condition variable whose waits can be stopped. Every wait holds the lock again when it returns. A predicate begins
/// with assert_held() of its mutex.
class Condition {
 public:
  void notify_one() noexcept { condition_.notify_one(); }
  void notify_all() noexcept { condition_.notify_all(); }

  template <typename Predicate>
  void wait(MutexLock& lock, Predicate predicate) {
    condition_.wait(lock, std::move(predicate));
  }
  /// The predicate's value; false only if a stop was requested.
  template <typename Predicate>
  bool wait(MutexLock& lock, std::stop_token stop, Predicate predicate) {
    return condition_.wait(lock, std::move(stop), std::move(predicate));
  }
  /// The predicate's value; false if the time is over.
  template <typename Clock, typename Duration, typename Predicate>
  bool wait_until(MutexLock& lock, const std::chrono::time_point<Clock, Duration>& deadline, Predicate predicate) {
    return condition_.wait_until(lock, deadline, std::move(predicate));
  }
  /// The predicate's value; false if the time is over or a stop was requested.
  template <typename Clock, typename Duration, typename Predicate>
  bool wait_until(MutexLock& lock, std::stop_token stop, const std::chrono::time_point<Clock, Duration>& deadline,
                  Predicate predicate) {
    return condition_.wait_until(lock, std::move(stop), deadline, std::move(predicate));
  }
  template <typename Rep, typename Period, typename Predicate>
  bool wait_for(MutexLock& lock, const std::chrono::duration<Rep, Period>& time, Predicate predicate) {
    return condition_.wait_for(lock, time, std::move(predicate));
  }
  template <typename Rep, typename Period, typename Predicate>
  bool wait_for(MutexLock& lock, std::stop_token stop, const std::chrono::duration<Rep, Period>& time,
                Predicate predicate) {
    return condition_.wait_for(lock, std::move(stop), time, std::move(predicate));
  }

 private:
  std::condition_variable_any condition_;
};

}  // namespace fvd
