#pragma once

/// Maps the camera's timestamps to the host's monotonic clock.

#include <optional>

#include <arv.h>

#include "core/hw/clock.hpp"

namespace fvd {

/// The latch register is read with the host's clock taken before and after; of many tries the quickest bounds the error
/// best (some 10 us on a local link). Renewed now and then, because the two clocks drift.
/// context: the device's thread.
class CameraClock {
 public:
  /// Measures anew if the last measurement is older than kRenewAfter. Without a latch in the camera there is no map.
  void measure(ArvDevice* device);

  [[nodiscard]] bool measured() const { return offset_.has_value(); }

  /// Host time of a camera timestamp in ns; nothing without a map.
  [[nodiscard]] std::optional<HostTime> to_host(std::uint64_t camera_ns) const;

 private:
  static constexpr std::chrono::seconds kRenewAfter{10};

  std::optional<HostClock::duration> offset_;  // host = camera + offset
  HostTime measured_{};
};

}  // namespace fvd
