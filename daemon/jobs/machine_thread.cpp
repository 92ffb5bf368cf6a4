#include "daemon/jobs/machine_thread.hpp"

#include <chrono>
#include <optional>
#include <utility>

#include <spdlog/spdlog.h>

#include "core/base/error.hpp"
#include "core/runtime/guarded_thread.hpp"

namespace fvd {

namespace {

/// How often an idle thread looks after its devices, and how often when one is missing.
constexpr std::chrono::milliseconds kDeviceCheckPeriod{500};
constexpr std::chrono::milliseconds kDeviceRetryPeriod{200};
/// A whole command; an autofocus may have a thousand looks. A job says for each of its steps how long it may take.
constexpr std::chrono::minutes kLongestCommand{60};

}  // namespace

MachineThread::MachineThread(DeviceHub& hub, MachineBoard& board, WorkQueue& work, ThreadTicks& ticks,
                             std::function<void()> in_between)
    : hub_(hub), board_(board), work_(work), ticks_(ticks), in_between_(std::move(in_between)) {}

void MachineThread::start() {
  thread_ = start_thread("fvd-machine", [this](std::stop_token stop) { run(stop); });
}

MachineThread::~MachineThread() { finish(); }

void MachineThread::request_stop() { thread_.request_stop(); }

void MachineThread::finish() {
  request_stop();
  if (thread_.joinable()) thread_.join();
  work_.close();
}

void MachineThread::run(std::stop_token stop) {
  while (!stop.stop_requested()) {
    ticks_.tick(HostClock::now());
    const bool complete = look_after_devices();
    in_between_();
    const auto work = work_.take(stop, complete ? kDeviceCheckPeriod : kDeviceRetryPeriod);
    if (!work) continue;
    ticks_.tick(HostClock::now(), kLongestCommand);
    work->run();
  }
  hub_.drop_all();
  ticks_.rest();
}

bool MachineThread::look_after_devices() {
  const std::optional<DeviceFailure> failure = hub_.open();
  const std::optional<DeviceFailure> alarm = hub_.alarm();
  const MachineRecord known = board_.read();
  if (alarm && alarm != told_alarm_) spdlog::error("no job is taken: {}: {}", error_name(alarm->code), alarm->message);
  if (!alarm && told_alarm_ && !failure) spdlog::info("the drive's alarm has ended");
  if (alarm || !failure) told_alarm_ = alarm;
  if (failure && failure != known.failure) spdlog::warn("{}: {}", error_name(failure->code), failure->message);
  const DevicesState now = failure ? DevicesState::kDown : DevicesState::kUp;
  const bool reopened = std::exchange(known_openings_, hub_.openings()) != hub_.openings();
  if (known.failure == failure && known.alarm == alarm && known.state.devices == now && !reopened) return !failure;
  board_.update([&](MachineRecord& machine) {
    machine.set_devices(failure);
    machine.set_alarm(alarm);
    machine.devices = failure ? std::nullopt : std::optional(hub_.facts());
  });
  return !failure;
}

}  // namespace fvd
