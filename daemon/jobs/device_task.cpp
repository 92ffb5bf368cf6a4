#include "daemon/jobs/device_task.hpp"

#include <utility>

namespace fvd {

void DeviceTask::end(Outcome outcome) noexcept {
  const MutexLock lock(mutex_);
  if (!outcome_) outcome_ = std::move(outcome);
}

void DeviceTask::run(const Devices& devices, std::stop_token stop) noexcept {
  try {
    end({work_(devices, std::move(stop)), std::nullopt, {}});
  } catch (const Error& error) {
    fail(error.code(), error.what());
  } catch (const std::exception& error) {
    fail(ErrorCode::kInternal, error.what());
  }
}

void DeviceTask::fail(ErrorCode code, const std::string& message) noexcept { end({{}, code, message}); }

std::optional<DeviceTask::Outcome> DeviceTask::outcome() const {
  const MutexLock lock(mutex_);
  return outcome_;
}

}  // namespace fvd
