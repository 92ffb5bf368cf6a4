#include "drivers/aravis/camera_clock.hpp"

#include "drivers/aravis/gobject.hpp"

namespace fvd {

namespace {

constexpr int kTries = 30;

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

}  // namespace

void CameraClock::measure(ArvDevice* device) {
  if (offset_ && HostClock::now() - measured_ < kRenewAfter) return;
  const auto latch = latch_of(device);
  if (!latch) return;
  GErrorSlot error;
  double ns_per_tick = 1.0;
  if (latch->tick_frequency != nullptr) {
    const gint64 frequency = arv_device_get_integer_feature_value(device, latch->tick_frequency, error.out());
    if (error.failed() || frequency <= 0) return;
    ns_per_tick = 1e9 / static_cast<double>(frequency);
  }
  auto quickest = HostClock::duration::max();
  for (int i = 0; i < kTries; ++i) {
    const HostTime before = HostClock::now();
    arv_device_execute_command(device, latch->command, error.out());
    const HostTime after = HostClock::now();
    if (error.failed()) return;
    const gint64 ticks = arv_device_get_integer_feature_value(device, latch->value, error.out());
    if (error.failed()) return;
    if (after - before >= quickest) continue;
    quickest = after - before;
    const std::chrono::nanoseconds camera(static_cast<std::int64_t>(static_cast<double>(ticks) * ns_per_tick));
    offset_ = (before + (after - before) / 2).time_since_epoch() - camera;
    measured_ = after;
  }
}

std::optional<HostTime> CameraClock::to_host(std::uint64_t camera_ns) const {
  if (!offset_) return std::nullopt;
  return HostTime(*offset_ + std::chrono::nanoseconds(static_cast<std::int64_t>(camera_ns)));
}

}  // namespace fvd
