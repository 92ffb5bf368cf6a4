#include "drivers/common/rest_detector.hpp"

#include <algorithm>
#include <cstdint>

namespace fvd {

namespace {

constexpr std::chrono::milliseconds kGrace{2000};  ///< beyond the braking time

}  // namespace

bool RestDetector::add(HostTime time, Micrometers position, bool reports_rest) {
  if (!reports_rest) {
    count_ = 0;
    return false;
  }
  const auto [low, high] = std::minmax({low_, high_, position});
  if (count_ == 0 || high - low > window_) {
    ++restarts_;
    count_ = 1;
    first_ = time;
    low_ = high_ = position;
    return false;
  }
  low_ = low;
  high_ = high;
  return ++count_ >= kLooks && time - first_ >= kDuration;
}

std::chrono::milliseconds standstill_timeout(double speed_um_per_s, double acceleration_um_per_s2) {
  if (acceleration_um_per_s2 <= 0.0) return kGrace;
  return kGrace +
         std::chrono::milliseconds(static_cast<std::int64_t>(1000.0 * speed_um_per_s / acceleration_um_per_s2));
}

}  // namespace fvd
