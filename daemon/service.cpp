#include "daemon/service.hpp"

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <spdlog/spdlog.h>
#include <unistd.h>

#include "core/base/error.hpp"
#include "core/base/exception_text.hpp"
#include "core/runtime/guarded_thread.hpp"
#include "daemon/app.hpp"
#include "daemon/base/exit_code.hpp"
#include "daemon/base/service_log.hpp"
#include "daemon/base/service_watchdog.hpp"
#include "daemon/base/systemd_notify.hpp"
#include "daemon/base/version.hpp"
#include "daemon/config_reload.hpp"
#include "daemon/devices/left_threads.hpp"
#include "daemon/jobs/alarm_sink.hpp"
#include "daemon/port_probe.hpp"

namespace fvd {

namespace {

constexpr std::chrono::milliseconds kPortRetryPeriod{200};
/// Less than the service manager allows for a start (TimeoutStartSec=); it starts the program again then.
constexpr std::chrono::seconds kPortPatience{60};

/// The signals that the main thread waits for; no other thread sees them.
class ServiceSignals {
 public:
  /// To be made before any thread exists, so that all inherit the mask.
  ServiceSignals() {
    sigemptyset(&set_);
    for (const int signal : {SIGTERM, SIGINT, SIGHUP}) sigaddset(&set_, signal);
    sigprocmask(SIG_BLOCK, &set_, nullptr);
    std::signal(SIGPIPE, SIG_IGN);
  }
  /// The signal that came within that time, -1 if none did.
  [[nodiscard]] int within(std::chrono::milliseconds time) const {
    const timespec left{time.count() / 1000, time.count() % 1000 * 1'000'000};
    return sigtimedwait(&set_, nullptr, &left);
  }

 private:
  sigset_t set_{};
};

bool ends(int signal) { return signal == SIGTERM || signal == SIGINT; }

std::optional<std::string> why_no_ports(const Config& config) {
  if (auto reason = why_no_port(config.rpc.address, config.rpc.port)) return reason;
  if (config.http.port) {
    if (auto reason = why_no_port(config.http.address, *config.http.port)) return reason;
  }
  return config.metrics.port ? why_no_port(config.metrics.address, *config.metrics.port) : std::nullopt;
}

/// Waits until clients could connect; returns all the same once its patience is over, for the start tells the failure
/// then. False if a signal to end came meanwhile. Nothing is opened before: the epoch counts starts that serve.
bool await_ports(const Config& config, const ServiceSignals& signals) {
  if (std::getenv("NOTIFY_SOCKET") == nullptr) return true;  // a person gets the reason at once
  const HostTime deadline = HostClock::now() + kPortPatience;
  std::string told;
  while (const auto reason = why_no_ports(config)) {
    if (*reason != told) spdlog::warn("{}; trying again", *reason);
    if (*reason != told) notify_status("waiting: " + *reason);
    told = *reason;
    if (HostClock::now() > deadline) break;
    if (ends(signals.within(kPortRetryPeriod))) return false;
  }
  return true;
}

void reload(const Options& options, Config& config, App& app, const std::string& status) {
  notify_reloading();
  const LoadedConfig wanted = load_config(options.config_file, options.overrides);
  const Reload plan = plan_reload(config, wanted);
  if (!plan.refusal.empty()) {
    spdlog::error("the configuration was read again and nothing of it is taken: {}", plan.refusal);
    app.engine().note_configuration(config, "SIGHUP: nothing of it was taken, the log says why",
                                    error_name(ErrorCode::kBadConfig));
    return notify_ready(status + "; the last reload was refused, the log says why");
  }
  std::string changes;
  for (const std::string& change : plan.changes) {
    spdlog::info("reloaded {}", change);
    changes += (changes.empty() ? "" : ", ") + change;
  }
  if (plan.changes.empty()) spdlog::info("the configuration was read again: nothing differs");
  config = wanted.config;
  set_log_level(spdlog::level::from_str(config.log.level));
  // Before it removes anything.
  app.engine().note_configuration(config, "SIGHUP: " + (changes.empty() ? "nothing differs" : changes));
  app.engine().take(config.store);
  notify_ready(status);
}

/// Feeds the watchdog and reloads until a signal to end comes, which it returns.
int await_end(const Options& options, Config& config, App& app, const ServiceSignals& signals,
              const std::string& status) {
  ServiceWatchdog watchdog;
  for (;;) {
    watchdog.look(HostClock::now());
    const int signal = signals.within(ServiceWatchdog::interval());
    if (ends(signal)) return signal;
    if (signal == SIGHUP) reload(options, config, app, status);
  }
}

}  // namespace

int serve(const Options& options, Config config) {
  const auto alarms = std::make_shared<AlarmLog>();
  set_up_service_log(alarm_sink(alarms));
  set_log_level(spdlog::level::from_str(config.log.level));
  spdlog::info("fvd {} starts", kVersion);
  const ServiceSignals signals;
  static std::atomic<bool> thread_failed = false;
  set_thread_failure_handler([](std::string_view name, const std::exception_ptr& failure) {
    spdlog::critical("thread {} ended by an exception, the program stops: {}", name, exception_text(failure));
    thread_failed = true;
    ::kill(::getpid(), SIGTERM);
  });
  if (!await_ports(config, signals)) return exit_code::kOk;
  App app(config, options.new_database, alarms);
  spdlog::info("listening on {}:{}", config.rpc.address, app.rpc_port());
  if (const auto port = app.http_port()) spdlog::info("HTTP on {}:{}", config.http.address, *port);
  if (const auto port = app.metrics_port()) spdlog::info("metrics on {}:{}", config.metrics.address, *port);
  const std::string status = "listening on port " + std::to_string(app.rpc_port());
  notify_ready(status);
  spdlog::info("signal {}: stopping", await_end(options, config, app, signals, status));
  process_ends();
  notify_stopping();
  return thread_failed ? exit_code::kInternal : exit_code::kOk;
}

}  // namespace fvd
