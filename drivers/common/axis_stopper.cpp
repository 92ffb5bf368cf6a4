#include "drivers/common/axis_stopper.hpp"

#include <algorithm>
#include <exception>

#include <spdlog/spdlog.h>

#include "core/base/error.hpp"

namespace fvd {

namespace {

using std::chrono::milliseconds;

constexpr int kStopAttempts = 3;
constexpr int kStandstillSamples = 3;
constexpr milliseconds kStandstillDuration{50};
constexpr Micrometers kStandstillWindow{1.0};
constexpr milliseconds kStandstillTimeout{2000};  ///< beyond the braking time
constexpr milliseconds kSampleGrace{200};         ///< for a sample that is due when the time is over

/// The samples since the axis was last seen moving.
class RestingSamples {
 public:
  /// True once they are a standstill.
  bool add(const AxisSample& sample) {
    if (!sample.reports_rest()) {
      count_ = 0;
      return false;
    }
    const auto [low, high] = std::minmax({low_, high_, sample.position});
    if (count_ == 0 || high - low > kStandstillWindow) {
      begin(sample);
      return false;
    }
    low_ = low;
    high_ = high;
    return ++count_ >= kStandstillSamples && sample.time - first_ >= kStandstillDuration;
  }
  [[nodiscard]] bool restarted() const { return restarts_ > 1 || count_ == 0; }

 private:
  void begin(const AxisSample& sample) {
    ++restarts_;
    count_ = 1;
    first_ = sample.time;
    low_ = high_ = sample.position;
  }

  int count_ = 0;
  int restarts_ = 0;
  HostTime first_{};
  Micrometers low_{};
  Micrometers high_{};
};

}  // namespace

AxisStopper::AxisStopper(AxisPort& port, AxisPoller& poller, const MotionLimits& limits)
    : port_(port),
      poller_(poller),
      braking_(static_cast<std::int64_t>(1000.0 * limits.speed_um_per_s / limits.acceleration_um_per_s2)) {}

std::string AxisStopper::send() noexcept {
  try {
    CommandResult result;
    for (int attempt = 0; attempt < kStopAttempts; ++attempt) {
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
    if (wait_for_standstill(HostClock::now() + braking_ + kStandstillTimeout, true)) return {};
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
  return wait_for_standstill(HostClock::now() + kStandstillTimeout + port_.traits().sample_timeout, false);
}

bool AxisStopper::wait_for_standstill(HostTime deadline, bool patient) {
  RestingSamples samples;
  for (HostTime last = HostClock::now(); HostClock::now() < deadline;) {
    const AxisSample sample = poller_.sample_after(last, {}, deadline + kSampleGrace);
    last = sample.begun;
    if (samples.add(sample)) return true;
    if (!patient && samples.restarted()) return false;
  }
  return false;
}

}  // namespace fvd
