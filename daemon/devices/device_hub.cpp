#include "daemon/devices/device_hub.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include <spdlog/spdlog.h>

#include "daemon/devices/standstill.hpp"
#include "drivers/common/rest_detector.hpp"

namespace fvd {

namespace {

/// An axis that is sampled all the time is sampled some times within this: an older sample tells nothing of now.
constexpr std::chrono::milliseconds kLongestSampleAge{200};

}  // namespace

DeviceHub::DeviceHub(DeviceOpeners openers, Clock& clock, std::function<void(bool)> on_rest)
    : clock_(clock),
      on_rest_(std::move(on_rest)),
      camera_(std::move(openers.camera), ErrorCode::kCameraDisconnected, Predecessor::kIgnored, "fvd-reap-camera"),
      axis_(std::move(openers.axis), ErrorCode::kStageDisconnected, Predecessor::kAwaited, "fvd-reap-stage") {
  // The axis first: one that moves on from before is stopped before a camera is waited for.
  rows_.push_back({.kind = "stage", .slot = axis_, .check = [this] { return check_axis(); }});
  rows_.push_back({.kind = "camera",
                   .slot = camera_,
                   .renewed_after = {ErrorCode::kCameraFramesLost, ErrorCode::kCameraNoFrames},
                   .check = [this] { return check_camera(); }});
}

std::optional<DeviceFailure> DeviceHub::open() {
  if (!axis_.connected()) set_at_rest(false);
  std::optional<DeviceFailure> failure;
  for (const Row& row : rows_) {
    if (!row.slot.ensure()) {
      if (!failure) failure = row.slot.failure();  // the first row's is told: the axis before the camera
    } else if (row.check) {
      if (auto found = row.check(); found && !failure) failure = std::move(found);
    }
  }
  return failure;
}

std::optional<DeviceFailure> DeviceHub::lost() {
  if (!axis_.connected()) set_at_rest(false);
  for (const Row& row : rows_) {
    if (!row.slot.connected()) {
      return DeviceFailure{row.slot.lost(), std::string("the connection to the ") + row.kind + " was lost"};
    }
  }
  return std::nullopt;
}

std::optional<DeviceFailure> DeviceHub::failure() {
  if (auto gone = lost()) return gone;
  return restless_;
}

std::optional<DeviceFailure> DeviceHub::alarm() const {
  if (!axis_.connected()) return std::nullopt;
  const std::optional<StageStatus> seen = axis_.get().last_seen();
  if (!seen) return std::nullopt;
  if (seen->lost_torque && !seen->alarm && seen->state != AxisState::kAlarm) {
    return DeviceFailure{ErrorCode::kStageAlarm,
                         "the drive was disabled, and not by fvd: an emergency stop, an alarm or a power cut? See to "
                         "it, then stage.home"};
  }
  if (!seen->alarm && seen->state != AxisState::kAlarm) return std::nullopt;
  if (!seen->alarm) {
    return DeviceFailure{ErrorCode::kStageAlarm,
                         "the drive's emergency stop is on; release it, then error.reset and stage.home"};
  }
  return DeviceFailure{ErrorCode::kStageAlarm, "the drive has " + seen->alarm_text +
                                                   "; see to the cause, then error.reset, which tells it to end the "
                                                   "alarm, and stage.home"};
}

void DeviceHub::confirm_rest() { (void)measure_standstill(); }

std::optional<DeviceFailure> DeviceHub::after_failure(ErrorCode code, const std::string& message) {
  if (code == axis_.lost()) axis_.drop();  // whatever it says of itself: nothing more is asked of it
  std::optional<DeviceFailure> failure = lost();
  if (axis_.connected()) {
    if (auto moving = standstill_or_drop()) failure = std::move(moving);
  }
  for (const Row& row : rows_) {
    if (row.slot.lost() == code) {
      row.slot.drop();
      failure = DeviceFailure{code, message};
    } else if (std::find(row.renewed_after.begin(), row.renewed_after.end(), code) != row.renewed_after.end()) {
      row.slot.drop();
    }
  }
  return failure;
}

void DeviceHub::drop_all() {
  for (const Row& row : rows_) row.slot.drop();
}

DeviceFacts DeviceHub::facts() const {
  DeviceFacts facts{axis_.get().info(), camera_.get().info()};
  facts.simulated = facts.camera.simulated || facts.stage.simulated;
  return facts;
}

DevicesHealth DeviceHub::health() const {
  DevicesHealth health{.camera = {camera_.connected(), camera_.openings()},
                       .stage = {axis_.connected(), axis_.openings()}};
  if (health.camera.open) health.frames = camera_.get().health();
  if (!health.stage.open) return health;
  const StageInfo stage = axis_.get().info();
  health.reach = StageReach{stage.min, stage.max};
  health.link = axis_.get().link_stats();
  if (const auto seen = axis_.get().last_seen()) {
    health.temperatures = seen->temperatures;
    health.position = seen->position;
  }
  return health;
}

std::optional<DeviceFailure> DeviceHub::check_camera() {
  camera_.get().look_after();
  if (camera_.connected()) return std::nullopt;
  camera_.drop();
  return DeviceFailure{camera_.lost(), "the connection to the camera was lost; it is being opened again"};
}

std::optional<DeviceFailure> DeviceHub::check_axis() {
  const bool checked = std::exchange(checked_opening_, axis_.openings()) == axis_.openings() && at_rest_;
  if (checked && !moved_unasked()) return std::nullopt;
  set_at_rest(false);  // until it is measured
  return standstill_or_drop();
}

std::optional<DeviceFailure> DeviceHub::standstill_or_drop() {
  auto failure = measure_standstill();
  if (failure && failure->code == axis_.lost()) axis_.drop();
  return failure;
}

bool DeviceHub::seen_standing() const {
  const Rest rest = last_rest();
  const auto stands = axis_.seen([&rest](const Axis& axis) {
    if (!axis.connected()) return false;
    const std::optional<StageStatus> seen = axis.last_seen();
    if (!seen) return true;
    return HostClock::now() - seen->sampled <= kLongestSampleAge && !reports_motion(*seen) &&
           rest.holds(seen->position);
  });
  return stands.value_or(false);
}

bool DeviceHub::moved_unasked() const {
  // A report of motion alone is none: some drives say so for every disturbance of a servo that holds.
  const std::optional<StageStatus> seen = axis_.get().last_seen();
  const Rest rest = last_rest();
  if (!seen || rest.holds(seen->position)) return false;
  spdlog::warn(
      "the stage is at {} um and rested at {} um, and fvd did not move it: was it moved by hand, or by another master?",
      seen->position.value, rest.place.value);
  return true;
}

std::optional<DeviceFailure> DeviceHub::measure_standstill() {
  restless_.reset();
  try {
    const auto rest = bring_to_rest(axis_.get(), clock_, [this] { set_at_rest(false); });
    if (rest) {
      const Rest measured{*rest, rest_window(axis_.get().info().feedback_resolution) * 2.0};
      const MutexLock lock(rest_mutex_);
      rest_ = measured;
    } else {
      restless_ = {ErrorCode::kNotReady, "the stage was found moving and is being stopped; wait until it rests"};
    }
  } catch (const Error& error) {
    restless_ = {error.code(), error.what()};
  } catch (const std::exception& error) {
    restless_ = {ErrorCode::kInternal, error.what()};
  }
  set_at_rest(!restless_);
  return restless_;
}

DeviceHub::Rest DeviceHub::last_rest() const {
  const MutexLock lock(rest_mutex_);
  return rest_;
}

void DeviceHub::set_at_rest(bool at_rest) {
  if (std::exchange(at_rest_, at_rest) != at_rest) on_rest_(at_rest);
}

}  // namespace fvd
