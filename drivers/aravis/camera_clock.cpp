#include "drivers/aravis/camera_clock.hpp"

#include <algorithm>
#include <cmath>

#include "drivers/aravis/gobject.hpp"

namespace fvd {

namespace {

constexpr int kLatches = 12;
/// Pairs closer together than this say nothing of the rate.
constexpr std::chrono::seconds kRateBase{2};
constexpr std::chrono::seconds kRateSpan{60};
/// A larger difference is no drift: the camera's clock was set anew.
constexpr double kLargestRateError = 1e-3;

/// The two names of the latch: GigE Vision 1.x in ticks, SFNC 2 in ns.
struct Latch {
  const char* command;
  const char* value;
  const char* tick_frequency;  // nullptr: ns
};
constexpr Latch kGigeVision{"GevTimestampControlLatch", "GevTimestampValue", "GevTimestampTickFrequency"};
constexpr Latch kSfnc{"TimestampLatch", "TimestampLatchValue", nullptr};

std::optional<Latch> latch_of(ArvDevice* device) {
  for (const Latch& latch : {kGigeVision, kSfnc}) {
    if (arv_device_is_feature_available(device, latch.command, nullptr) != FALSE &&
        arv_device_is_feature_available(device, latch.value, nullptr) != FALSE) {
      return latch;
    }
  }
  return std::nullopt;
}

double nanoseconds(HostClock::duration duration) { return std::chrono::duration<double, std::nano>(duration).count(); }

/// Host time over camera time between two pairs.
double rate_between(const ClockPair& from, const ClockPair& to) {
  return nanoseconds(to.host - from.host) / static_cast<double>(to.camera_ns - from.camera_ns);
}

}  // namespace

std::optional<ClockPair> latch_clock(ArvDevice* device) {
  const auto latch = latch_of(device);
  if (!latch) return std::nullopt;
  GErrorSlot error;
  double ns_per_tick = 1.0;
  if (latch->tick_frequency != nullptr) {
    const gint64 frequency = arv_device_get_integer_feature_value(device, latch->tick_frequency, error.out());
    if (error.failed() || frequency <= 0) return std::nullopt;
    ns_per_tick = 1e9 / static_cast<double>(frequency);
  }
  std::optional<ClockPair> best;
  for (int i = 0; i < kLatches; ++i) {
    const HostTime before = HostClock::now();
    arv_device_execute_command(device, latch->command, error.out());
    const HostTime after = HostClock::now();
    if (error.failed()) return std::nullopt;
    const gint64 ticks = arv_device_get_integer_feature_value(device, latch->value, error.out());
    if (error.failed()) return std::nullopt;
    const auto bound = (after - before) / 2;
    if (best && bound >= best->bound) continue;
    best = ClockPair{std::llround(static_cast<long double>(ticks) * ns_per_tick), before + bound, bound};
  }
  return best;
}

void CameraClock::add(const ClockPair& pair) {
  const MutexLock lock(mutex_);
  doubted_ = false;
  const bool follows = first_ && pair.camera_ns > latest_->camera_ns && pair.host > latest_->host &&
                       std::abs(rate_between(*latest_, pair) - 1.0) <=
                           kLargestRateError + nanoseconds(pair.bound + latest_->bound) /
                                                   static_cast<double>(pair.camera_ns - latest_->camera_ns);
  if (!follows) {
    first_ = pair;
  } else if (pair.host - first_->host > kRateSpan) {
    first_ = latest_;  // the rate changes with temperature
  }
  latest_ = pair;
}

void CameraClock::doubt() {
  const MutexLock lock(mutex_);
  doubted_ = latest_.has_value();
}

bool CameraClock::known() const {
  const MutexLock lock(mutex_);
  return latest_.has_value();
}

bool CameraClock::due(HostTime now) const { return is_older(now, renew_after_); }

bool CameraClock::due_soon(HostTime now) const { return is_older(now, renew_after_ / 2); }

bool CameraClock::is_older(HostTime now, HostClock::duration age) const {
  const MutexLock lock(mutex_);
  return !latest_ || doubted_ || now - latest_->host > age;
}

std::optional<HostTime> CameraClock::to_host(std::uint64_t camera_ns) const {
  const MutexLock lock(mutex_);
  if (!latest_) return std::nullopt;
  const double rate = latest_->host - first_->host >= kRateBase ? rate_between(*first_, *latest_) : 1.0;
  // A number of 64 bit that means nothing must not become a host time that overflows.
  constexpr double kMonth_ns = 30.0 * 24 * 3600 * 1e9;
  // The difference of unsigned numbers is exact, and right for the times before as well.
  const auto difference = static_cast<std::int64_t>(camera_ns - static_cast<std::uint64_t>(latest_->camera_ns));
  const double since = std::clamp(static_cast<double>(difference), -kMonth_ns, kMonth_ns);
  return latest_->host + std::chrono::nanoseconds(std::llround(since * rate));
}

}  // namespace fvd
