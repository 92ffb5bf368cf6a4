#pragma once

/// Conversion of the camera's clock to the host's.

#include <chrono>
#include <cstdint>
#include <optional>

#include <arv.h>

#include "core/base/clock.hpp"
#include "core/base/mutex.hpp"

namespace fvd {

/// The same moment on both clocks.
struct ClockPair {
  std::int64_t camera_ns = 0;
  HostTime host{};
  HostClock::duration bound{};  ///< largest difference between the two moments
};

/// Latches the camera's clock some ten times and keeps the latch with the shortest round trip; nothing if the camera
/// has no latch that works. Blocks for as many commands. context: the device's thread.
[[nodiscard]] std::optional<ClockPair> latch_clock(ArvDevice* device);

/// Offset and rate from pairs taken every few seconds: quartz clocks differ by up to 0.1 ms per second.
/// context: thread-safe.
class CameraClock {
 public:
  /// renew_after: a pair this old should be followed by another.
  explicit CameraClock(std::chrono::milliseconds renew_after) : renew_after_(renew_after) {}

  void add(const ClockPair& pair);
  /// A frame's time cannot be right: the camera's clock may have been set. due() is true until the next pair.
  void doubt();
  [[nodiscard]] bool known() const;
  /// Whether another pair should be added; true before the first.
  [[nodiscard]] bool due(HostTime now) const;
  /// The same from half of that age on: who has time to spare adds it now, and nobody has to who has none.
  [[nodiscard]] bool due_soon(HostTime now) const;
  /// Host time of a camera time, within a month of the latest pair; nothing before the first.
  [[nodiscard]] std::optional<HostTime> to_host(std::uint64_t camera_ns) const;

 private:
  [[nodiscard]] bool is_older(HostTime now, HostClock::duration age) const;

  const std::chrono::milliseconds renew_after_;
  mutable Mutex mutex_;
  std::optional<ClockPair> first_ FVD_GUARDED_BY(mutex_);  // of the present rate
  std::optional<ClockPair> latest_ FVD_GUARDED_BY(mutex_);
  bool doubted_ FVD_GUARDED_BY(mutex_) = false;
};

}  // namespace fvd
