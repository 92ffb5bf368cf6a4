#pragma once

/// Detects threads that hang in a piece of work.

#include <atomic>
#include <chrono>
#include <string>
#include <vector>

#include "core/base/clock.hpp"

namespace fvd {

/// One thread's ticks; stalled_threads() watches the thread for as long as this object lives. A thread ticks when it
/// begins a piece of work, and rests while it waits for the next one, which may take for ever.
/// context: the thread itself; age() and the accessors any thread.
class ThreadTicks {
 public:
  /// allowed: longest time from one tick to the next or to rest(). The thread rests until its first tick.
  ThreadTicks(std::string name, std::chrono::milliseconds allowed);
  ~ThreadTicks();
  ThreadTicks(const ThreadTicks&) = delete;
  ThreadTicks& operator=(const ThreadTicks&) = delete;

  void tick(HostTime now) noexcept { tick(now, longest_); }
  /// Before a step that may take longer, or must not take as long: until the next tick `allowed` holds.
  void tick(HostTime now, std::chrono::milliseconds allowed) noexcept {
    // In this order: whoever sees the new limit sees the new tick. A look takes the limit first.
    last_ = now;
    allowed_ = allowed;
  }
  void rest() noexcept { last_ = kResting; }

  [[nodiscard]] const std::string& name() const { return name_; }
  /// Time since the last tick; 0 while the thread rests.
  [[nodiscard]] HostClock::duration age(HostTime now) const noexcept;
  [[nodiscard]] std::chrono::milliseconds allowed() const noexcept { return allowed_.load(); }

 private:
  static constexpr HostTime kResting = HostTime::min();

  const std::string name_;
  const std::chrono::milliseconds longest_;
  std::atomic<std::chrono::milliseconds> allowed_{longest_};
  std::atomic<HostTime> last_{kResting};
};

struct StalledThread {
  std::string name;
  std::chrono::milliseconds age;  ///< since its last tick
  std::chrono::milliseconds allowed;

  bool operator==(const StalledThread&) const = default;
};

/// The threads of the process whose last tick is older than allowed, in the order in which their ThreadTicks were made.
/// context: thread-safe.
[[nodiscard]] std::vector<StalledThread> stalled_threads(HostTime now);

}  // namespace fvd
