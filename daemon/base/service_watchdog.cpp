#include "daemon/base/service_watchdog.hpp"

#include <algorithm>
#include <cstdint>
#include <utility>

#include <spdlog/spdlog.h>
#include <systemd/sd-daemon.h>

#include "core/runtime/thread_ticks.hpp"
#include "daemon/base/systemd_notify.hpp"

namespace fvd {

namespace {

bool holds(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

std::chrono::milliseconds ServiceWatchdog::interval() {
  std::uint64_t allowed_us = 0;
  if (sd_watchdog_enabled(0, &allowed_us) <= 0) return std::chrono::seconds(1);
  return std::chrono::milliseconds(std::max<std::uint64_t>(allowed_us / 3000, 1));
}

void ServiceWatchdog::look(HostTime now) {
  std::vector<std::string> stalled;
  for (const StalledThread& thread : stalled_threads(now)) {
    if (!holds(stalled_, thread.name)) {
      spdlog::critical(
          "thread {} has not ticked for {} ms, it may take {} ms; systemd is told no more that all is well",
          thread.name, thread.age.count(), thread.allowed.count());
    }
    stalled.push_back(thread.name);
  }
  for (const std::string& name : stalled_) {
    if (!holds(stalled, name)) spdlog::warn("thread {} gets on again", name);
  }
  stalled_ = std::move(stalled);
  if (stalled_.empty()) notify_watchdog();
}

}  // namespace fvd
