#include "daemon/jobs/device_task.hpp"

#include <utility>

namespace fvd {

void DeviceTask::foretell(const Outcome& outcome) noexcept {
  std::function<void(const Outcome&)> when_ended;
  {
    const MutexLock lock(mutex_);
    when_ended = std::exchange(when_ended_, {});
  }
  if (when_ended) when_ended(outcome);
}

void DeviceTask::end(Outcome outcome) noexcept {
  foretell(outcome);
  const MutexLock lock(mutex_);
  if (outcome_) return;
  // Before anybody sees the outcome: whoever has his answer finds what was noted of it.
  if (look_) std::exchange(look_, {})(outcome);
  outcome_ = std::move(outcome);
}

void DeviceTask::note_outcome(std::function<void(const Outcome&)> look) {
  const MutexLock lock(mutex_);
  if (outcome_) return look(*outcome_);
  look_ = std::move(look);
}

DeviceTask::Outcome DeviceTask::perform(const Devices& devices, std::stop_token stop) const noexcept {
  try {
    return {work_(devices, std::move(stop)), std::nullopt, {}};
  } catch (const Error& error) {
    return {{}, error.code(), error.what()};
  } catch (const std::exception& error) {
    return {{}, ErrorCode::kInternal, error.what()};
  }
}

void DeviceTask::run(const Devices& devices, std::stop_token stop) noexcept { end(perform(devices, std::move(stop))); }

void DeviceTask::fail(ErrorCode code, const std::string& message) noexcept { end({{}, code, message}); }

std::optional<DeviceTask::Outcome> DeviceTask::outcome() const {
  const MutexLock lock(mutex_);
  return outcome_;
}

}  // namespace fvd
