#pragma once

/// The service's sign of life: systemd restarts the program once it is missing.

#include <chrono>
#include <string>
#include <vector>

#include "core/base/clock.hpp"

namespace fvd {

/// context: one thread, which calls look() for as long as the program serves.
class ServiceWatchdog {
 public:
  /// Time between two calls of look(): a third of systemd's watchdog time, 1 s if systemd does not watch the service.
  [[nodiscard]] static std::chrono::milliseconds interval();

  /// Sends WATCHDOG=1 unless a thread has stalled (stalled_threads()) for which a measurement may wait. Logs once when
  /// a thread stalls, and once when it works again.
  void look(HostTime now);

 private:
  std::vector<std::string> stalled_;  // names, at the last look
};

}  // namespace fvd
