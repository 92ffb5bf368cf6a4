#pragma once

/// The physics of one Z axis: where the stage truly is at any moment, and what its encoder says.

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "core/base/clock.hpp"

namespace fvd::sim {

/// The part on which the drive's encoder is mounted.
enum class Feedback {
  kMotorEncoder,  ///< on the motor's shaft: measures neither backlash nor screw error nor drift
  kLinearScale,   ///< on the stage: measures its true position, which the drive does not correct
};

/// All errors of the axis; 0 switches an error off.
struct AxisParameters {
  double steps_per_um = 100.0;          ///< commanded steps per um (electronic gear)
  double encoder_resolution_um = 0.01;  ///< encoder quantum
  double encoder_noise_um = 0.0;        ///< standard deviation of a reading
  double settle_noise_um = 0.0;         ///< standard deviation of the resting position, drawn once per move
  double ring_amplitude_um = 0.0;       ///< amplitude of the damped oscillation after a move
  double ring_frequency_hz = 70.0;
  double ring_decay_ms = 15.0;
  double backlash_um = 0.0;       ///< lost motion on reversal; a motor encoder does not measure it
  double lead_error_um = 0.0;     ///< amplitude of the periodic screw error; a motor encoder does not measure it
  double lead_um = 1000.0;        ///< screw lead, the period of lead_error_um
  double lead_phase_deg = 0.0;    ///< phase of lead_error_um at motor position 0
  double scale_error = 0.0;       ///< alpha_z - 1: true motion over commanded motion, about position 0
  double drift_um_per_min = 0.0;  ///< drift of the true position with time
  double temperature_c = 20.0;    ///< temperature of the axis at the start
  double temperature_rate_k_per_min = 0.0;
  double drift_um_per_k = 0.0;  ///< drift of the true position with temperature
  Feedback feedback = Feedback::kMotorEncoder;
  double start_latency_ms = 0.0;         ///< from command to motion; in_position() is stale meanwhile
  double home_position_um = 0.0;         ///< where homing ends
  double power_on_position_um = -200.0;  ///< true position before homing
  bool reversed = false;                 ///< the true position falls as the drive's steps grow, about 0
  std::uint64_t seed = 1;
};

/// Trapezoidal motion with the errors above; every call is a pure function of the commands, their times and the seed.
/// context: thread-safe.
class AxisModel {
 public:
  explicit AxisModel(const AxisParameters& parameters);
  ~AxisModel();

  [[nodiscard]] const AxisParameters& parameters() const noexcept;

  /// Absolute move in steps; speed in steps/s, acceleration and deceleration in steps/s^2, all > 0.
  void move_to(HostTime now, std::int32_t target_steps, double speed, double acceleration, double deceleration);
  void stop(HostTime now);
  void home(HostTime now);
  /// The drive loses its reference; the true position stays.
  void power_cycle(HostTime now);

  /// Calls `watch` at every command with its time and words: "move <target um>", "stop", "home". Empty: nobody is
  /// called. The call must not come back to the axis.
  void watch_commands(std::function<void(HostTime, const std::string&)> watch);

  [[nodiscard]] bool moving(HostTime now) const;
  [[nodiscard]] bool in_position(HostTime now) const;
  [[nodiscard]] bool homed(HostTime now) const;
  [[nodiscard]] std::int32_t command_steps(HostTime now) const;
  [[nodiscard]] std::int32_t encoder_steps(HostTime now) const;

  /// Temperature of the axis, degC.
  [[nodiscard]] double temperature_c(HostTime at) const;

  /// True position of the focal plane. `at` must not lie before the last command.
  [[nodiscard]] double true_position_um(HostTime at) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fvd::sim
