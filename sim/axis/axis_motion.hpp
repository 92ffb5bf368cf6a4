#pragma once

/// A move as stretches of constant acceleration: pure arithmetic, no errors, no clock.

#include <vector>

namespace fvd::sim {

/// Limits of a move; speed in um/s, accelerations in um/s^2, all > 0.
struct MotionLimits {
  double speed = 0.0;
  double acceleration = 0.0;
  double deceleration = 0.0;
};

/// Position and velocity at a moment, um and um/s.
struct MotionState {
  double position = 0.0;
  double velocity = 0.0;
};

class MotionProfile {
 public:
  /// At rest.
  explicit MotionProfile(double position) : rest_(position) {}

  /// From any state to rest at `target`, as fast as the limits allow: a trapezoid, or a triangle when short. Brakes to
  /// rest first where the state runs the wrong way or too fast to stop in time.
  static MotionProfile to(MotionState from, double target, const MotionLimits& limits);
  /// Brakes to rest.
  static MotionProfile brake(MotionState from, double deceleration);

  /// t in seconds since the start; before the start the first, after the end the resting position.
  [[nodiscard]] MotionState at(double t) const;
  [[nodiscard]] double duration() const;
  [[nodiscard]] double end() const { return rest_; }
  /// Positions at the ends of the stretches up to t, and at t: between two of them the motion runs one way.
  [[nodiscard]] std::vector<double> turning_points(double t) const;

 private:
  struct Stretch {
    double start;  // s
    double duration;
    MotionState from;
    double acceleration;
  };
  [[nodiscard]] static MotionState state_in(const Stretch& stretch, double t);
  void add(MotionState from, double acceleration, double duration);

  std::vector<Stretch> stretches_;
  double rest_ = 0.0;
};

}  // namespace fvd::sim
