#include "drivers/modbus/axis_poller.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <pthread.h>
#include <spdlog/spdlog.h>

#include "core/base/error.hpp"

namespace fvd {

namespace {

using std::chrono::milliseconds;

constexpr milliseconds kFastPoll{2};
constexpr milliseconds kIdlePoll{50};
constexpr milliseconds kFastFor{1000};  ///< sampling stays fast for so long after the last thing that needed it
constexpr milliseconds kTemperatureEvery{1000};
constexpr std::size_t kLoggedSamples = 8192;

/// A position is believed at once if it lies within what twice the commanded speed reaches, and so much more.
constexpr double kSpeedMargin = 2.0;
constexpr double kPositionMargin_um = 50.0;

}  // namespace

AxisPoller::AxisPoller(ModbusLink& link, const DriveProfile& profile, double max_speed_um_per_s)
    : link_(link), profile_(profile), max_speed_um_per_s_(max_speed_um_per_s), log_(kLoggedSamples) {
  poll_once();
  if (!connected_) throw Error(ErrorCode::kStageDisconnected, loss_);
  thread_ = std::jthread([this](std::stop_token stop) { run(stop); });
  pthread_setname_np(thread_.native_handle(), "fvd-stage");
}

AxisPoller::~AxisPoller() = default;

void AxisPoller::run(std::stop_token stop) {
  while (!stop.stop_requested() && connected_) {
    {
      const std::lock_guard polling(polling_);
      poll_once();
      read_temperatures();
    }
    std::unique_lock lock(mutex_);
    const HostTime now = HostClock::now();
    const HostTime next = now + (now < fast_until_ ? kFastPoll : kIdlePoll);
    const HostTime fast_until = fast_until_;
    wake_.wait_until(lock, stop, next, [&] { return fast_until_ != fast_until && next - now > kFastPoll; });
  }
}

std::optional<AxisSample> AxisPoller::read_sample(std::string& error) {
  RegisterImage image;
  AxisSample sample;
  sample.begun = HostClock::now();
  for (const PollBlock& block : profile_.poll) {
    ModbusReply reply = link_.read(block.table, block.address, block.count);
    if (reply.outcome != ModbusOutcome::kOk) {
      error = reply.error;
      return std::nullopt;
    }
    sample.time = reply.sampled;  // the last block's, which holds the position
    image.add(block, std::move(reply.values));
  }
  const auto lookup = [&](const DriveRegister& reg) { return image.value(reg); };
  const auto holds = [&](const DriveCondition& condition) { return condition.holds(lookup).value_or(false); };
  const auto holds_if = [&](const std::optional<DriveCondition>& condition) { return condition && holds(*condition); };
  sample.position = Micrometers{profile_.direction * static_cast<double>(image.value(profile_.position).value_or(0)) /
                                profile_.counts_per_um};
  sample.enabled = holds(profile_.enabled);
  sample.homed = profile_.homed ? holds(*profile_.homed) : homed_.load();
  sample.moving = holds(profile_.moving);
  sample.in_position = holds(profile_.in_position);
  sample.alarm = holds(profile_.alarm);
  if (profile_.target) sample.target = image.value(*profile_.target);
  if (sample.alarm) {
    auto code = image.value(profile_.alarm_code);
    if (!code) code = read_register(link_, profile_.alarm_code);
    sample.alarm_code = static_cast<int>(code.value_or(0));
    const auto known = profile_.alarms.find(sample.alarm_code);
    if (known != profile_.alarms.end() && known->second.position_lost) homed_ = false;
  }
  sample.limit_positive = holds_if(profile_.limit_positive);
  sample.limit_negative = holds_if(profile_.limit_negative);
  sample.emergency_stop = holds_if(profile_.emergency_stop);
  return sample;
}

bool AxisPoller::plausible(const AxisSample& sample) const {
  const auto last = log_.latest();
  if (!last) return true;
  const double seconds = std::chrono::duration<double>(sample.time - last->time).count();
  const double reach_um = kSpeedMargin * max_speed_um_per_s_ * seconds + kPositionMargin_um;
  return std::abs((sample.position - last->position).value) <= reach_um;
}

void AxisPoller::poll_once() {
  std::string error;
  auto sample = read_sample(error);
  const auto doubtful = [&] {
    const std::lock_guard lock(mutex_);
    return sample && !plausible(*sample);
  };
  if (doubtful()) {
    // A jump is real after a power cycle or a preset; then the second reading says the same.
    ++implausible_;
    spdlog::debug("stage: a position of {} um cannot have been reached; reading again", sample->position.value);
    sample = read_sample(error);
  }
  if (!sample) {
    lose(error);
  } else {
    const std::lock_guard lock(mutex_);
    log_.add(*sample);
  }
  sampled_.notify_all();
}

void AxisPoller::lose(const std::string& error) {
  bool moved = false;
  {
    const std::lock_guard lock(mutex_);
    const auto last = log_.latest();
    moved = last && last->moving;
    loss_ = "the drive at " + link_.description() + " does not answer: " + error;
  }
  connected_ = false;
  if (!moved) return;
  const auto result = run_sequence(link_, profile_.stop, {}, ModbusPriority::kUrgent, {});
  spdlog::error("stage lost in motion; stop {}", result.outcome == ModbusOutcome::kOk ? "confirmed" : "not confirmed");
}

void AxisPoller::read_temperatures() {
  const HostTime now = HostClock::now();
  if (profile_.temperatures.empty() || !connected_ || now - temperatures_read_ < kTemperatureEvery) return;
  temperatures_read_ = now;
  std::vector<StageTemperature> read;
  for (const DriveTemperature& temperature : profile_.temperatures) {
    const auto value = read_register(link_, temperature.reg);
    if (value) read.push_back({temperature.name, static_cast<double>(*value) * temperature.celsius_per_unit});
  }
  const std::lock_guard lock(mutex_);
  temperatures_ = std::move(read);
}

std::vector<StageTemperature> AxisPoller::temperatures() const {
  const std::lock_guard lock(mutex_);
  return temperatures_;
}

AxisSample AxisPoller::sample_after(HostTime after, std::stop_token stop) {
  std::unique_lock lock(mutex_);
  fast_until_ = HostClock::now() + kFastFor;
  wake_.notify_all();
  const auto there = [&] {
    const auto latest = log_.latest();
    return !connected_ || (latest && latest->begun > after);
  };
  if (!sampled_.wait(lock, stop, there)) throw Error(ErrorCode::kAborted, "the axis was asked to stop");
  if (!connected_) throw Error(ErrorCode::kStageDisconnected, loss_);
  return *log_.latest();
}

PositionMean AxisPoller::mean(HostTime from, HostTime to) {
  const std::lock_guard lock(mutex_);
  return log_.mean(from, to);
}

PositionMean AxisPoller::line(HostTime at, std::chrono::microseconds reach) {
  const std::lock_guard lock(mutex_);
  return log_.line(at, reach);
}

}  // namespace fvd
