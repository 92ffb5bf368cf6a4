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
  /// Time between two looks: a third of what systemd allows, 1 s where it watches nothing.
  [[nodiscard]] static std::chrono::milliseconds interval();

  /// Sends WATCHDOG=1 unless a thread has stalled (stalled_threads). Logs which thread stalls, and when it is over,
  /// once each.
  void look(HostTime now);

 private:
  std::vector<std::string> stalled_;  // names, at the last look
};

}  // namespace fvd
