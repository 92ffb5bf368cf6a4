#include "sim/axis/axis_model.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <numbers>
#include <random>

#include "core/base/mutex.hpp"
#include "sim/axis/axis_motion.hpp"

namespace fvd::sim {

namespace {

double seconds(HostClock::duration duration) { return std::chrono::duration<double>(duration).count(); }

/// Load position behind a play of `backlash`: pushed up by the motor, it rests on it; going down the gap opens first.
double follow(double load, double motor, double backlash) { return std::clamp(load, motor, motor + backlash); }

}  // namespace

struct AxisModel::Impl {
  /// A command and what the axis does from it on. Positions in um of the true axis; `origin` is what the drive calls 0.
  struct Move {
    HostTime start{};
    MotionProfile profile{0.0};
    MotionLimits limits;
    double load_before = 0.0;   // load position at the start, behind the backlash
    double rest_before = 0.0;   // resting error carried in, um
    double rest_error = 0.0;    // resting error after the move, um
    double origin = 0.0;        // while it runs
    double origin_after = 0.0;  // once it ended
    bool homed_before = false;
    bool homed_after = false;
    bool rings = false;
  };

  explicit Impl(const AxisParameters& parameters)
      : p(parameters), random(parameters.seed), encoder_random(parameters.seed ^ 0x9E3779B97F4A7C15U) {
    Move rest;
    rest.start = HostTime::min();
    rest.profile = MotionProfile(p.power_on_position_um);
    rest.load_before = p.power_on_position_um;
    rest.origin = rest.origin_after = p.power_on_position_um;
    moves.push_back(rest);
  }

  /// The command in force at a moment: the last one that has started.
  [[nodiscard]] const Move& move_at(HostTime at) const FVD_REQUIRES(mutex) {
    for (auto move = moves.rbegin(); move != moves.rend(); ++move) {
      if (move->start <= at) return *move;
    }
    return moves.front();
  }

  [[nodiscard]] double since_start(const Move& move, HostTime at) const {
    return move.start == HostTime::min() ? 1e9 : seconds(at - move.start);
  }

  [[nodiscard]] bool running(const Move& move, HostTime at) const {
    return since_start(move, at) < move.profile.duration();
  }

  /// The motor shaft: the profile, the resting error that changes over on the way, and the ringing after it.
  [[nodiscard]] double motor_um(const Move& move, HostTime at) const {
    const double t = since_start(move, at);
    const double duration = move.profile.duration();
    const double done = duration > 0 ? std::clamp(t / duration, 0.0, 1.0) : 1.0;
    double position = move.profile.at(t).position + move.rest_before + done * (move.rest_error - move.rest_before);
    const double after = t - duration;
    if (move.rings && after > 0) {
      position += p.ring_amplitude_um * std::exp(-1000.0 * after / p.ring_decay_ms) *
                  std::sin(2.0 * std::numbers::pi * p.ring_frequency_hz * after);
    }
    return position;
  }

  [[nodiscard]] double load_um(const Move& move, HostTime at) const {
    double load = move.load_before;
    for (const double point : move.profile.turning_points(since_start(move, at))) {
      load = follow(load, point, p.backlash_um);
    }
    return load;
  }

  /// The true position, counted the way that steps grow.
  [[nodiscard]] double true_um(HostTime at) const FVD_REQUIRES(mutex) {
    const Move& move = move_at(at);
    // What the motor does beyond its profile, the load does too.
    const double deviation = motor_um(move, at) - move.profile.at(since_start(move, at)).position;
    const double load = load_um(move, at);
    return stage_um(load, deviation) + p.drift_um_per_min * minutes(at) +
           p.drift_um_per_k * p.temperature_rate_k_per_min * minutes(at);
  }

  /// Where screw and scale put the stage for a load position, and a deviation of the motor from it.
  [[nodiscard]] double stage_um(double load, double deviation) const {
    const double screw = p.lead_error_um * std::sin(2.0 * std::numbers::pi * load / p.lead_um +
                                                    p.lead_phase_deg * std::numbers::pi / 180.0);
    const double motor = load + deviation;
    return motor + p.scale_error * motor + screw;
  }

  [[nodiscard]] double minutes(HostTime at) const { return seconds(at - born) / 60.0; }

  [[nodiscard]] double origin_um(const Move& move, HostTime at) const {
    return running(move, at) ? move.origin : move.origin_after;
  }

  /// Prepares the next command: the state it starts from, all errors carried over.
  [[nodiscard]] Move successor(HostTime now) const FVD_REQUIRES(mutex) {
    Move next;
    next.start = now + std::chrono::duration_cast<HostClock::duration>(
                           std::chrono::duration<double, std::milli>(p.start_latency_ms));
    const Move& last = move_at(next.start);
    const double t = since_start(last, next.start);
    const double duration = last.profile.duration();
    const double done = duration > 0 ? std::clamp(t / duration, 0.0, 1.0) : 1.0;
    next.load_before = load_um(last, next.start);
    next.rest_before = last.rest_before + done * (last.rest_error - last.rest_before);
    next.rest_error = next.rest_before;
    next.origin = next.origin_after = origin_um(last, next.start);
    next.homed_before = next.homed_after = running(last, next.start) ? last.homed_before : last.homed_after;
    next.limits = last.limits;
    return next;
  }

  [[nodiscard]] MotionState state(HostTime at) const FVD_REQUIRES(mutex) {
    const Move& move = move_at(at);
    return move.profile.at(since_start(move, at));
  }

  void add(const Move& move) FVD_REQUIRES(mutex) {
    moves.push_back(move);
    // A time asked for is never before the last command, but that one may not have started yet.
    while (moves.size() > 4) moves.pop_front();
  }

  void tell(HostTime at, const std::string& command) FVD_REQUIRES(mutex) {
    if (watch) watch(at, command);
  }

  double draw_rest_error() FVD_REQUIRES(mutex) { return p.settle_noise_um * normal(random); }

  const AxisParameters p;
  const HostTime born = HostClock::now();
  mutable Mutex mutex;
  std::mt19937_64 random FVD_GUARDED_BY(mutex);
  mutable std::mt19937_64 encoder_random FVD_GUARDED_BY(mutex);
  std::normal_distribution<double> normal FVD_GUARDED_BY(mutex);
  mutable std::normal_distribution<double> encoder_normal FVD_GUARDED_BY(mutex);
  std::deque<Move> moves FVD_GUARDED_BY(mutex);
  std::function<void(HostTime, const std::string&)> watch FVD_GUARDED_BY(mutex);
};

AxisModel::AxisModel(const AxisParameters& parameters) : impl_(std::make_unique<Impl>(parameters)) {}
AxisModel::~AxisModel() = default;

const AxisParameters& AxisModel::parameters() const noexcept { return impl_->p; }

void AxisModel::watch_commands(std::function<void(HostTime, const std::string&)> watch) {
  const MutexLock lock(impl_->mutex);
  impl_->watch = std::move(watch);
}

void AxisModel::move_to(HostTime now, std::int32_t target_steps, double speed, double acceleration,
                        double deceleration) {
  const MutexLock lock(impl_->mutex);
  const double per_um = impl_->p.steps_per_um;
  impl_->tell(now, "move " + std::to_string(target_steps / per_um));
  auto move = impl_->successor(now);
  move.limits = {speed / per_um, acceleration / per_um, deceleration / per_um};
  move.profile = MotionProfile::to(impl_->state(move.start), move.origin + target_steps / per_um, move.limits);
  move.rest_error = impl_->draw_rest_error();
  move.rings = true;
  impl_->add(move);
}

void AxisModel::stop(HostTime now) {
  const MutexLock lock(impl_->mutex);
  impl_->tell(now, "stop");
  auto move = impl_->successor(now);
  const double deceleration = move.limits.deceleration > 0 ? move.limits.deceleration : 1e4;
  move.profile = MotionProfile::brake(impl_->state(move.start), deceleration);
  move.rings = move.profile.duration() > 0;
  impl_->add(move);
}

void AxisModel::home(HostTime now) {
  const MutexLock lock(impl_->mutex);
  impl_->tell(now, "home");
  auto move = impl_->successor(now);
  // The drive's own homing speed, whatever moves were commanded before.
  move.limits = {2000.0, 20000.0, 20000.0};
  move.profile = MotionProfile::to(impl_->state(move.start), impl_->p.home_position_um, move.limits);
  move.rest_error = impl_->draw_rest_error();
  move.origin_after = 0.0;
  move.homed_before = false;
  move.homed_after = true;
  impl_->add(move);
}

void AxisModel::power_cycle(HostTime now) {
  const MutexLock lock(impl_->mutex);
  auto move = impl_->successor(now);
  move.start = now;
  const double rest = impl_->state(now).position;
  move.profile = MotionProfile(rest);
  move.origin = move.origin_after = rest;
  move.homed_before = move.homed_after = false;
  impl_->add(move);
}

bool AxisModel::moving(HostTime now) const {
  const MutexLock lock(impl_->mutex);
  return impl_->running(impl_->move_at(now), now);
}

bool AxisModel::in_position(HostTime now) const { return !moving(now); }

bool AxisModel::homed(HostTime now) const {
  const MutexLock lock(impl_->mutex);
  const auto& move = impl_->move_at(now);
  return impl_->running(move, now) ? move.homed_before : move.homed_after;
}

std::int32_t AxisModel::command_steps(HostTime now) const {
  const MutexLock lock(impl_->mutex);
  const auto& move = impl_->move_at(now);
  const double position = move.profile.at(impl_->since_start(move, now)).position - impl_->origin_um(move, now);
  return static_cast<std::int32_t>(std::lround(position * impl_->p.steps_per_um));
}

std::int32_t AxisModel::encoder_steps(HostTime now) const {
  const MutexLock lock(impl_->mutex);
  const auto& move = impl_->move_at(now);
  const double noise = impl_->p.encoder_noise_um * impl_->encoder_normal(impl_->encoder_random);
  const double origin = impl_->origin_um(move, now);
  const double seen = impl_->p.feedback == Feedback::kLinearScale
                          ? impl_->true_um(now) - impl_->stage_um(origin, 0.0)  // 0 at the origin
                          : impl_->motor_um(move, now) - origin;
  const double position = seen + noise;
  const double resolution = impl_->p.encoder_resolution_um;
  const double quantised = resolution > 0 ? std::round(position / resolution) * resolution : position;
  return static_cast<std::int32_t>(std::lround(quantised * impl_->p.steps_per_um));
}

double AxisModel::temperature_c(HostTime at) const {
  return impl_->p.temperature_c + impl_->p.temperature_rate_k_per_min * impl_->minutes(at);
}

double AxisModel::true_position_um(HostTime at) const {
  const MutexLock lock(impl_->mutex);
  return impl_->p.reversed ? -impl_->true_um(at) : impl_->true_um(at);
}

}  // namespace fvd::sim
