#include "drivers/common/axis_stopper.hpp"

#include <exception>

#include <spdlog/spdlog.h>

#include "core/base/error.hpp"
#include "drivers/common/rest_detector.hpp"

namespace fvd {

namespace {

using std::chrono::milliseconds;

constexpr int kStopAttempts = 3;
constexpr milliseconds kSampleGrace{200};  ///< for a sample that is due when the time is over

}  // namespace

AxisStopper::AxisStopper(AxisPort& port, AxisPoller& poller, const MotionLimits& limits)
    : port_(port),
      poller_(poller),
      timeout_(standstill_timeout(limits.speed_um_per_s, limits.acceleration_um_per_s2)) {}

std::string AxisStopper::send() noexcept {
  try {
    CommandResult result;
    for (int attempt = 0; attempt < kStopAttempts && !result.later; ++attempt) {
      result = port_.stop();
      if (result.outcome == CommandOutcome::kDone) return {};
    }
    spdlog::error("stage stop was not confirmed: {}", result.error);
    return "the stop was not taken: " + result.error;
  } catch (const std::exception& error) {
    spdlog::error("stage stop failed: {}", error.what());
    return std::string("the stop could not be sent: ") + error.what();
  }
}

std::string AxisStopper::halt() noexcept {
  const std::string refusal = send();
  try {
    if (wait_for_standstill(HostClock::now() + timeout_, true)) return {};
    return "standstill was not confirmed: the axis still moves; " + (refusal.empty() ? "it took the stop" : refusal);
  } catch (const std::exception& error) {
    return std::string("standstill was not confirmed: ") + error.what() + (refusal.empty() ? "" : "; " + refusal);
  }
}

void AxisStopper::halt_if_moving() noexcept {
  try {
    if (!poller_.connected() || poller_.latest().reports_rest()) return;
    spdlog::warn("the stage at {} is closed while it moves; it is stopped", port_.traits().address);
    if (const std::string why = halt(); !why.empty()) spdlog::error("stage closed: {}", why);
  } catch (const std::exception& error) {
    spdlog::error("stage closed: whether it rests is not known: {}", error.what());
  }
}

bool AxisStopper::rests() {
  return wait_for_standstill(HostClock::now() + timeout_ + port_.traits().sample_timeout, false);
}

bool AxisStopper::wait_for_standstill(HostTime deadline, bool patient) {
  RestDetector rest(rest_window(port_.traits().feedback_resolution));
  for (HostTime last = HostClock::now(); HostClock::now() < deadline;) {
    const AxisSample sample = poller_.sample_after(last, {}, deadline + kSampleGrace);
    last = sample.begun;
    if (rest.add(sample.time, sample.position, sample.reports_rest())) return true;
    if (!patient && rest.saw_motion()) return false;
  }
  return false;
}

}  // namespace fvd
