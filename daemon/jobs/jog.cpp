#include "daemon/jobs/jog.hpp"

#include <algorithm>
#include <chrono>
#include <sstream>
#include <thread>
#include <utility>

#include <nlohmann/json.hpp>

#include "core/runtime/guarded_thread.hpp"
#include "daemon/jobs/objective_limits.hpp"

namespace fvd {

namespace {

constexpr std::chrono::seconds kFailureIsNews{1};
constexpr std::chrono::milliseconds kLetGo{500};  // no repeat for so long: whoever asks again means to
constexpr double kLongestBraking_s = 0.04;

/// Inside the limits by one step, for a target is rounded to whole steps.
Micrometers target_of(const JogRequest& request, const Devices& devices) {
  StageInfo stage = devices.stage.info();
  if (devices.objective != nullptr) stage = limited_by(*devices.objective, stage);
  const Micrometers target = request.up ? stage.max - stage.step_quantum : stage.min + stage.step_quantum;
  const Micrometers here = devices.stage.status().position;
  if (request.up ? here < target : here > target) return target;
  std::ostringstream message;
  message << "the stage is at " << here.value << " um, its " << (request.up ? "upper" : "lower")
          << " limit; nothing was moved";
  throw Error(ErrorCode::kStageLimit, message.str());
}

/// Nobody watches a jog's end but a person with a hand on the part: it is no faster than the axis can halt from at
/// once.
double speed_of(const JogRequest& request, const StageInfo& stage) {
  const double asked = request.speed_um_per_s;
  const double braked = stage.acceleration_um_per_s2 * kLongestBraking_s;
  return braked > 0.0 && asked <= stage.speed_um_per_s ? std::min(asked, braked) : asked;  // or the axis refuses it
}

void jog(const Devices& devices, JogHold& hold, const std::stop_token& stop) {
  const Micrometers target = target_of(hold.request(), devices);
  std::stop_source ends;
  const std::stop_callback passed_on(stop, [&ends] { ends.request_stop(); });
  const std::jthread watch = start_thread("fvd-jog", [&hold, &ends](std::stop_token leave) {
    hold.wait_until_over(std::move(leave));
    ends.request_stop();
  });
  try {
    (void)devices.stage.sweep_to(target, speed_of(hold.request(), devices.stage.info()), ends.get_token());
  } catch (const Error& error) {
    if (error.code() != ErrorCode::kAborted || stop.stop_requested()) throw;
  }
}

}  // namespace

bool JogHold::extend(const JogRequest& request) {
  const MutexLock lock(mutex_);
  if (over_ || HostClock::now() >= until_) return false;
  const bool repeated = request_.repeats(request);
  until_ = repeated ? std::max(until_, request.until) : HostTime{};
  changed_.notify_all();
  return repeated;
}

void JogHold::wait_until_over(std::stop_token stop) {
  MutexLock lock(mutex_);
  while (!stop.stop_requested() && HostClock::now() < until_) {
    const HostTime deadline = until_;
    changed_.wait_until(lock, stop, deadline, [this, deadline] {
      mutex_.assert_held();
      return until_ != deadline;
    });
  }
  over_ = true;
}

void JogHold::fail(ErrorCode code, const std::string& message) {
  const MutexLock lock(mutex_);
  over_ = true;
  failure_.emplace(code, message);
  failed_ = refused_ = HostClock::now();
}

std::optional<Error> JogHold::take_failure(const JogRequest& repeat) {
  const MutexLock lock(mutex_);
  const HostTime now = HostClock::now();
  if (repeat.who != request_.who) return std::nullopt;
  if (failure_ && failure_->code() == ErrorCode::kAborted) {
    // A button that is still held goes on repeating after a stop, and must begin nothing.
    if (now - std::exchange(refused_, now) <= kLetGo) return failure_;
    failure_.reset();
  }
  auto failure = std::exchange(failure_, std::nullopt);
  if (!request_.repeats(repeat) || now - failed_ > kFailureIsNews) failure.reset();
  return failure;
}

std::shared_ptr<DeviceTask> jog_task(const std::shared_ptr<JogHold>& hold) {
  return std::make_shared<DeviceTask>(
      [hold](const Devices& devices, const std::stop_token& stop) {
        jog(devices, *hold, stop);
        return nlohmann::ordered_json{{"z_um", devices.stage.status().position.value}}.dump();
      },
      TaskMotion::kMoves,
      [hold](const DeviceTask::Outcome& outcome) {
        if (outcome.error) hold->fail(*outcome.error, outcome.message);
      });
}

}  // namespace fvd
