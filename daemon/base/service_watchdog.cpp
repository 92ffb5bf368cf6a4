#include "daemon/base/service_watchdog.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

#include <spdlog/spdlog.h>
#include <systemd/sd-daemon.h>

#include "core/runtime/thread_ticks.hpp"
#include "daemon/base/systemd_notify.hpp"

namespace fvd {

namespace {

/// They close cameras, remove files and tell people what was stored, for which nothing that measures waits: where they
/// hang a person must know, and a job that runs is not ended for it. Closing a stage is none of them, for no other is
/// opened before; nor is the making of files that follow, for a job may wait for their memory.
constexpr std::array kHarmless{"fvd-reap-camera", "fvd-retention", "fvd-http-work",
                               "fvd-http-files",  "fvd-rpc-lists", "fvd-maps"};

bool is_harmless(const std::string& name) {
  return std::find(kHarmless.begin(), kHarmless.end(), name) != kHarmless.end();
}

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
      const bool goes_on = is_harmless(thread.name);
      spdlog::log(goes_on ? spdlog::level::err : spdlog::level::critical,
                  "thread {} has not ticked for {} ms, it may take {} ms; {}", thread.name, thread.age.count(),
                  thread.allowed.count(),
                  goes_on ? "no measurement waits for it: the service goes on, restart it when it suits"
                          : "systemd is told no more that all is well");
    }
    stalled.push_back(thread.name);
  }
  for (const std::string& name : stalled_) {
    if (!holds(stalled, name)) spdlog::warn("thread {} gets on again", name);
  }
  stalled_ = std::move(stalled);
  if (std::all_of(stalled_.begin(), stalled_.end(), is_harmless)) notify_watchdog();
}

}  // namespace fvd
