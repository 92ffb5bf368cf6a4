#pragma once

/// State of the service for systemd (sd_notify(3)). Has no effect if systemd did not start the program.
/// context: thread-safe.

#include <chrono>
#include <string>

namespace fvd {

/// READY=1: the port is open; the devices are being opened. status: one line for systemctl
/// status.
void notify_ready(const std::string& status);
/// STATUS= alone.
void notify_status(const std::string& status);
/// EXTEND_TIMEOUT_USEC=, with STATUS=: the start goes on, and takes at most that long from now.
void notify_extend_timeout(std::chrono::seconds longest, const std::string& status);
/// RELOADING=1: the configuration is being read again; notify_ready() ends it.
void notify_reloading();
/// WATCHDOG=1: a sign of life.
void notify_watchdog();
/// STOPPING=1: the ordered stop has begun.
void notify_stopping();

}  // namespace fvd
