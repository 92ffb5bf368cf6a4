#include "drivers/common/axis_poller.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <spdlog/spdlog.h>

#include "core/base/error.hpp"
#include "core/base/exception_text.hpp"
#include "core/runtime/guarded_thread.hpp"
#include "core/runtime/thread_ticks.hpp"

namespace fvd {

namespace {

using std::chrono::milliseconds;

constexpr milliseconds kFastPeriod{2};
constexpr milliseconds kIdlePeriod{50};
constexpr milliseconds kFastDuration{1000};  ///< sampling stays fast this long after the last call that needed it
constexpr milliseconds kTemperaturePeriod{1000};
constexpr milliseconds kLookPeriod{200};  ///< for what another master writes
/// So long after the last write of another master he may still be there.
constexpr std::chrono::seconds kForeignTime{10};
constexpr std::size_t kLoggedSamples = 8192;

/// A position is believed at once if it lies within the reach of this multiple of the commanded speed, and this margin.
constexpr double kSpeedFactor = 2.0;
constexpr double kPositionMargin_um = 50.0;
/// A position is far outside the limits if it lies beyond them by as much as they are apart, and by this at least.
constexpr double kFar_um = 1000.0;
/// How often a position is read until two readings agree.
constexpr int kReadings = 5;
/// A poll that takes longer hangs: this multiple of the longest time between two samples of a line that is alive.
constexpr int kHangFactor = 6;

}  // namespace

AxisPoller::AxisPoller(AxisPort& port, double max_speed_um_per_s, Micrometers min, Micrometers max)
    : port_(port), max_speed_um_per_s_(max_speed_um_per_s), min_(min), max_(max), log_(kLoggedSamples) {
  {
    const MutexLock polling(polling_);
    poll_once();
  }
  {
    const MutexLock lock(mutex_);
    if (!connected_) throw Error(ErrorCode::kStageDisconnected, loss_);
  }
  thread_ = start_thread(
      "fvd-stage", [this](const std::stop_token& stop) { run(stop); },
      [this](std::string_view name, const std::exception_ptr& failure) {
        const std::string why = exception_text(failure);
        spdlog::error("thread {} ended by an exception: {}", name, why);
        if (lose("sampling ended by an exception: " + why)) stop_lost_axis();
      });
}

void AxisPoller::run(const std::stop_token& stop) {
  ThreadTicks ticks("fvd-stage", kHangFactor * port_.traits().sample_timeout);
  while (!stop.stop_requested() && connected()) {
    ticks.tick(HostClock::now());
    {
      const MutexLock lock(mutex_);
      asked_ = false;
    }
    {
      const MutexLock polling(polling_);
      poll_once();
      read_temperatures();
      look_for_others(stop);
    }
    MutexLock lock(mutex_);
    const HostTime now = HostClock::now();
    const HostTime next = now + (now < fast_until_ ? kFastPeriod : kIdlePeriod);
    const HostTime fast_until = fast_until_;
    wake_.wait_until(lock, stop, next, [&] {
      mutex_.assert_held();
      return asked_ || (fast_until_ != fast_until && next - now > kFastPeriod);
    });
  }
  if (stop.stop_requested()) lose("the driver is being closed");
}

std::optional<AxisSample> AxisPoller::read_sample(std::string& error) {
  auto sample = port_.sample(error);
  if (!sample) return sample;
  if (sample->reference_lost) homed_ = false;
  if (!port_.traits().tells_homed) sample->homed = homed_;
  return sample;
}

bool AxisPoller::reachable(const AxisSample& from, const AxisSample& to) const {
  const double seconds = std::chrono::duration<double>(to.time - from.time).count();
  const double reach_um = kSpeedFactor * max_speed_um_per_s_ * seconds + kPositionMargin_um;
  return std::abs((to.position - from.position).value) <= reach_um;
}

bool AxisPoller::far_outside(const AxisSample& sample) const {
  const Micrometers far = std::max(max_ - min_, Micrometers{kFar_um});
  return sample.position < min_ - far || sample.position > max_ + far;
}

namespace {

/// The third lies on the way from the first to the second: an axis that is faster than it is commanded to be, because
/// it homes at a speed of the drive's own or is turned by hand.
bool continues(const AxisSample& first, const AxisSample& second, const AxisSample& third) {
  const auto speed = [](const AxisSample& from, const AxisSample& to) {
    return (to.position - from.position).value / std::chrono::duration<double>(to.time - from.time).count();
  };
  const double before = speed(first, second);
  const double now = speed(second, third);
  return before * now >= 0.0 && std::abs(now) <= kSpeedFactor * std::abs(before);
}

}  // namespace

bool AxisPoller::publish(const AxisSample& sample, const std::optional<AxisSample>& doubtful) {
  const MutexLock lock(mutex_);
  const auto last = log_.latest();
  const bool agrees = doubtful && (reachable(*doubtful, sample) || (last && continues(*last, *doubtful, sample)));
  const bool is_doubtful = last ? !reachable(*last, sample) : far_outside(sample);
  if (is_doubtful && !agrees) return false;
  if (!last && is_doubtful) {
    spdlog::warn("the first position of the axis at {}, {} um, lies far outside the limits of {}..{} um{}",
                 port_.traits().address, sample.position.value, min_.value, max_.value, port_.traits().doubt_hint);
  }
  log_.add(sample);
  sampled_.notify_all();
  return true;
}

void AxisPoller::poll_once() {
  std::string error;
  std::optional<AxisSample> before;
  std::optional<AxisSample> doubtful;
  for (int reading = 0; reading < kReadings; ++reading) {
    const auto sample = read_sample(error);
    if (!sample) {
      if (lose("it does not answer: " + error)) stop_lost_axis();
      return;
    }
    // A jump is real after a power cycle or a preset; then the next reading says the same.
    if (publish(*sample, doubtful)) return;
    ++implausible_;
    spdlog::debug("stage: a position of {} um cannot have been reached; reading again", sample->position.value);
    before = std::exchange(doubtful, sample);
  }
  if (lose("its positions contradict one another, the last two are " + std::to_string(before->position.value) +
           " um and " + std::to_string(doubtful->position.value) + " um: check the line and the encoder" +
           port_.traits().doubt_hint)) {
    stop_lost_axis();
  }
}

void AxisPoller::stop_lost_axis() noexcept {
  try {
    const CommandResult stopped = port_.stop();
    spdlog::error("stage lost in motion; stop {}",
                  stopped.outcome == CommandOutcome::kDone ? "confirmed" : "not confirmed");
  } catch (const std::exception& error) {
    spdlog::error("stage lost in motion; stop failed: {}", error.what());
  }
}

bool AxisPoller::lose(const std::string& error) {
  const MutexLock lock(mutex_);
  if (!connected_) return false;
  connected_ = false;
  loss_ = "the drive at " + port_.traits().address + " is lost: " + error;
  sampled_.notify_all();
  const auto last = log_.latest();
  return last && last->moving;
}

void AxisPoller::read_temperatures() {
  const HostTime now = HostClock::now();
  if (!connected() || now - temperatures_read_ < kTemperaturePeriod) return;
  temperatures_read_ = now;
  std::vector<StageTemperature> read = port_.temperatures();
  const MutexLock lock(mutex_);
  temperatures_ = std::move(read);
}

void AxisPoller::look_for_others(const std::stop_token& stop) {
  const HostTime now = HostClock::now();
  if (!connected() || now - others_looked_for_ < kLookPeriod) return;
  others_looked_for_ = now;
  auto found = port_.foreign_write(stop);
  if (!found) return;
  spdlog::warn("{} the drive at {}: {}", found->is_restart ? "a restart of" : "another master writes to",
               port_.traits().address, found->what);
  const MutexLock lock(mutex_);
  foreign_ = std::move(found);
  foreign_seen_ = now;
}

std::optional<ForeignWrite> AxisPoller::foreign_write(bool look, const std::stop_token& stop) {
  if (look) {
    const MutexLock polling(polling_);
    others_looked_for_ = {};
    look_for_others(stop);
  }
  const MutexLock lock(mutex_);
  // A restart is over, and what it took is gone for good; a master may have gone away.
  if (foreign_ && !foreign_->is_restart && HostClock::now() - foreign_seen_ > kForeignTime) foreign_.reset();
  return foreign_;
}

void AxisPoller::forget_foreign_write() {
  const MutexLock lock(mutex_);
  foreign_.reset();
}

std::vector<StageTemperature> AxisPoller::temperatures() const {
  const MutexLock lock(mutex_);
  return temperatures_;
}

bool AxisPoller::connected() const noexcept {
  const MutexLock lock(mutex_);
  return connected_;
}

void AxisPoller::pause(const std::function<void()>& action) {
  const MutexLock polling(polling_);
  action();
}

AxisSample AxisPoller::sample_now(std::stop_token stop) {
  const HostTime now = HostClock::now();
  {
    const MutexLock lock(mutex_);
    asked_ = true;  // a poll that has begun already does not count: another one follows it at once
  }
  return sample_after(now, std::move(stop));
}

AxisSample AxisPoller::sample_after(HostTime after, std::stop_token stop) {
  return sample_after(after, std::move(stop), std::max(after, HostClock::now()) + port_.traits().sample_timeout);
}

AxisSample AxisPoller::sample_after(HostTime after, std::stop_token stop, HostTime deadline) {
  MutexLock lock(mutex_);
  fast_until_ = HostClock::now() + kFastDuration;
  wake_.notify_all();
  const bool ended = sampled_.wait_until(lock, stop, deadline, [&] {
    mutex_.assert_held();
    const auto latest = log_.latest();
    return !connected_ || (latest && latest->begun > after);
  });
  if (!ended && stop.stop_requested()) throw Error(ErrorCode::kAborted, "the axis was asked to stop");
  if (!connected_) throw Error(ErrorCode::kStageDisconnected, loss_);
  if (!ended) {
    throw Error(ErrorCode::kStageDisconnected,
                "the drive at " + port_.traits().address + " gave no position in time: is its line overloaded?");
  }
  return *log_.latest();
}

AxisSample AxisPoller::latest() const {
  const MutexLock lock(mutex_);
  return *log_.latest();
}

PositionMean AxisPoller::mean(HostTime from, HostTime to) const {
  const MutexLock lock(mutex_);
  return log_.mean(from, to);
}

PositionMean AxisPoller::line(HostTime at, std::chrono::microseconds reach) const {
  const MutexLock lock(mutex_);
  return log_.line(at, reach);
}

}  // namespace fvd
