#include "daemon/base/systemd_notify.hpp"

#include <algorithm>
#include <cstdint>
#include <ctime>

#include <systemd/sd-daemon.h>

namespace fvd {

namespace {

/// A line break would begin another assignment.
std::string one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == '\n' || c == '\r' || c == '\0'; }, ' ');
  return text;
}

/// Nothing depends on being heard, so a manager that does not listen is no error.
void notify(const std::string& state) { static_cast<void>(sd_notify(0, state.c_str())); }

}  // namespace

void notify_ready(const std::string& status) { notify("READY=1\nSTATUS=" + one_line(status)); }
void notify_status(const std::string& status) { notify("STATUS=" + one_line(status)); }
void notify_extend_timeout(std::chrono::seconds longest, const std::string& status) {
  notify("EXTEND_TIMEOUT_USEC=" + std::to_string(std::chrono::microseconds(longest).count()) +
         "\nSTATUS=" + one_line(status));
}
void notify_reloading() {
  timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  const std::int64_t now_us = std::int64_t{now.tv_sec} * 1'000'000 + now.tv_nsec / 1000;
  notify("RELOADING=1\nMONOTONIC_USEC=" + std::to_string(now_us));
}
void notify_watchdog() { notify("WATCHDOG=1"); }
void notify_stopping() { notify("STOPPING=1\nSTATUS=stopping"); }

}  // namespace fvd
