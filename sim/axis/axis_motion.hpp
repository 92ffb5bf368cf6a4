#pragma once

/// A move as phases of constant acceleration: pure arithmetic, no errors, no clock.

#include <vector>

namespace fvd::sim {

/// Limits of a move, all > 0.
struct MotionLimits {
  double speed = 0.0;         ///< um/s
  double acceleration = 0.0;  ///< um/s^2
  double deceleration = 0.0;  ///< um/s^2
};

/// Position and velocity at a moment.
struct MotionState {
  double position = 0.0;  ///< um
  double velocity = 0.0;  ///< um/s
};

class MotionProfile {
 public:
  /// At rest.
  explicit MotionProfile(double position) : rest_(position) {}

  /// From any state to rest at `target`, as fast as the limits allow: a trapezoid, or a triangle for short moves.
  /// Brakes to rest first if the motion has the wrong direction or is too fast to stop in time.
  static MotionProfile to(MotionState from, double target, const MotionLimits& limits);
  /// Brakes to rest.
  static MotionProfile brake(MotionState from, double deceleration);

  /// State t seconds after the start; the initial position for t < 0, the resting position after the end.
  [[nodiscard]] MotionState at(double t) const;
  [[nodiscard]] double duration() const;
  [[nodiscard]] double end() const { return rest_; }
  /// Positions at the ends of the phases up to t seconds, and at t: between two of them the direction is constant.
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
