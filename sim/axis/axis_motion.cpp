#include "sim/axis/axis_motion.hpp"

#include <algorithm>
#include <cmath>

namespace fvd::sim {

MotionState MotionProfile::state_in(const Stretch& stretch, double t) {
  const double dt = std::clamp(t - stretch.start, 0.0, stretch.duration);
  return {stretch.from.position + stretch.from.velocity * dt + 0.5 * stretch.acceleration * dt * dt,
          stretch.from.velocity + stretch.acceleration * dt};
}

void MotionProfile::add(MotionState from, double acceleration, double duration) {
  if (duration > 0) stretches_.push_back({this->duration(), duration, from, acceleration});
}

double MotionProfile::duration() const {
  return stretches_.empty() ? 0.0 : stretches_.back().start + stretches_.back().duration;
}

MotionProfile MotionProfile::brake(MotionState from, double deceleration) {
  const double time = std::abs(from.velocity) / deceleration;
  MotionProfile profile(from.position + 0.5 * from.velocity * time);
  profile.add(from, from.velocity > 0 ? -deceleration : deceleration, time);
  return profile;
}

MotionProfile MotionProfile::to(MotionState from, double target, const MotionLimits& limits) {
  MotionProfile profile(target);
  const auto stops_at = [&](MotionState state) {
    return state.position + 0.5 * state.velocity * std::abs(state.velocity) / limits.deceleration;
  };
  const double distance_after_stop = target - stops_at(from);
  if (from.velocity * distance_after_stop < 0 || (from.velocity != 0 && distance_after_stop == 0)) {
    profile = brake(from, limits.deceleration);
    from = {profile.rest_, 0.0};
    profile.rest_ = target;
  }
  const double direction = target >= from.position ? 1.0 : -1.0;
  const double distance = std::abs(target - from.position);
  const double initial = std::abs(from.velocity);
  const double sum = limits.acceleration + limits.deceleration;
  const double reachable = std::sqrt(
      (2.0 * limits.acceleration * limits.deceleration * distance + limits.deceleration * initial * initial) / sum);
  const double top = std::max(initial, std::min(limits.speed, reachable));
  const double speed_up = (top - initial) / limits.acceleration;
  profile.add(from, direction * limits.acceleration, speed_up);
  MotionState state{from.position + direction * 0.5 * (initial + top) * speed_up, direction * top};
  const double braking = top * top / (2.0 * limits.deceleration);
  const double cruise = top > 0 ? std::max(0.0, (std::abs(target - state.position) - braking) / top) : 0.0;
  profile.add(state, 0.0, cruise);
  state.position += direction * top * cruise;
  profile.add(state, -direction * limits.deceleration, top / limits.deceleration);
  return profile;
}

MotionState MotionProfile::at(double t) const {
  if (stretches_.empty() || t >= duration()) return {rest_, 0.0};
  for (const Stretch& stretch : stretches_) {
    if (t < stretch.start + stretch.duration) return state_in(stretch, t);
  }
  return {rest_, 0.0};
}

std::vector<double> MotionProfile::turning_points(double t) const {
  std::vector<double> points;
  for (const Stretch& stretch : stretches_) {
    if (t <= stretch.start) break;
    points.push_back(state_in(stretch, t).position);
  }
  points.push_back(at(t).position);
  return points;
}

}  // namespace fvd::sim
