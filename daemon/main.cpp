/// fvd: reads its configuration, starts, and waits for the signal to stop.

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <iostream>

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include "core/base/error.hpp"
#include "core/runtime/guarded_thread.hpp"
#include "daemon/app.hpp"
#include "daemon/base/exit_code.hpp"
#include "daemon/base/service_watchdog.hpp"
#include "daemon/base/systemd_notify.hpp"
#include "daemon/base/version.hpp"
#include "daemon/devices/reaper.hpp"
#include "daemon/options.hpp"

namespace fvd {
namespace {

std::string text_of(const std::exception_ptr& failure) {
  try {
    std::rethrow_exception(failure);
  } catch (const std::exception& error) {
    return error.what();
  } catch (...) {
    return "of an unknown kind";
  }
}

/// The signal that came within that time, -1 if none did.
int signal_within(const sigset_t& signals, std::chrono::milliseconds time) {
  const timespec left{time.count() / 1000, time.count() % 1000 * 1'000'000};
  return sigtimedwait(&signals, nullptr, &left);
}

int serve(const Config& config) {
  spdlog::set_default_logger(spdlog::stderr_color_mt("fvd"));
  spdlog::set_level(spdlog::level::from_str(config.log.level));
  spdlog::info("fvd {} starts", kVersion);
  // Before any thread exists, so that all inherit it: only the wait below sees these signals.
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGTERM);
  sigaddset(&signals, SIGINT);
  sigprocmask(SIG_BLOCK, &signals, nullptr);
  std::signal(SIGPIPE, SIG_IGN);

  std::atomic<bool> thread_failed = false;
  set_thread_failure_handler([&thread_failed](std::string_view name, const std::exception_ptr& failure) {
    spdlog::critical("thread {} ended by an exception, the program stops: {}", name, text_of(failure));
    thread_failed = true;
    ::kill(::getpid(), SIGTERM);
  });
  App app(config);
  spdlog::info("listening on {}:{}", config.rpc.address, app.rpc_port());
  notify_ready("listening on port " + std::to_string(app.rpc_port()));
  ServiceWatchdog watchdog;
  int received = -1;
  while (received < 0) {
    watchdog.look(HostClock::now());
    received = signal_within(signals, ServiceWatchdog::interval());
  }
  spdlog::info("signal {}: stopping", received);
  Reaper::process_ends();
  notify_stopping();
  return thread_failed ? exit_code::kInternal : exit_code::kOk;
}

}  // namespace
}  // namespace fvd

int main(int argc, char** argv) try {
  using namespace fvd;
  const ParsedOptions parsed = parse_options(argc, argv, std::cout, std::cerr);
  if (parsed.exit) return *parsed.exit;
  const StartUp start = start_up(parsed.options, std::cout, std::cerr);
  if (start.exit) return *start.exit;
  try {
    const int code = serve(start.config);
    if (!Reaper::left_a_device()) return code;
    spdlog::warn("a device that answers nothing is not closed in order; the system closes its connection");
    spdlog::shutdown();
    std::_Exit(code);
  } catch (const Error& error) {
    spdlog::critical("{}: {}", error_name(error.code()), error.what());
    return exit_code_of(error.code());
  }
} catch (const std::exception& error) {
  std::cerr << "fvd: " << error.what() << '\n';
  return fvd::exit_code::kInternal;
}
