#pragma once

/// Faults of a drive and its motor, the same for every register map.

#include "core/base/clock.hpp"

namespace fvd::sim {

/// context: any thread.
class DriveFaults {
 public:
  virtual ~DriveFaults() = default;

  /// The drive stops the axis and stays in alarm until it is reset. code: as the drive's alarm register shows it, > 0.
  virtual void raise_alarm(int code) = 0;
  /// The axis runs onto a limit switch: it stops and the drive says so in its own way.
  virtual void limit_hit() = 0;
  /// Torque is taken away (STO, HWTO): the axis stops and the drive says so in its own way.
  virtual void emergency_stop() = 0;
  /// Off and on again: reference, alarm and all written registers are lost.
  virtual void power_cycle() = 0;
  /// The next `count` starts of a motion are acknowledged and ignored.
  virtual void refuse_moves(int count) = 0;
  /// For this long the drive reports standstill in position, also while the axis moves.
  virtual void hold_in_position(HostClock::duration duration) = 0;
  /// While set, the words of 32-bit values go and come in the other order, as in a drive set up that way.
  virtual void exchange_words(bool exchanged) = 0;
  /// True while the axis truly moves.
  [[nodiscard]] virtual bool axis_moves() = 0;
};

}  // namespace fvd::sim
