#pragma once

/// Time as the scan sees it: monotonic, replaceable in tests, and every wait can be cut short.

#include <chrono>
#include <stop_token>

namespace fvd {

using HostClock = std::chrono::steady_clock;
using HostTime = HostClock::time_point;

/// context: thread-safe.
class Clock {
 public:
  virtual ~Clock() = default;
  [[nodiscard]] virtual HostTime now() const = 0;
  /// Returns at `deadline` or as soon as stop is requested.
  virtual void wait_until(HostTime deadline, std::stop_token stop) = 0;
};

/// The machine's monotonic clock.
class SystemClock final : public Clock {
 public:
  [[nodiscard]] HostTime now() const override { return HostClock::now(); }
  void wait_until(HostTime deadline, std::stop_token stop) override;
};

}  // namespace fvd
