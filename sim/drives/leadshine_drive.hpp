#pragma once

/// The registers of a Leadshine CS2RS closed-loop stepper drive in PR mode (CS2RS manual p. 26, 43, 50, 59; position
/// registers iEM-RS manual p. 19; addresses are PDU addresses, 32-bit values high word first) on a simulated axis.

#include <optional>

#include "sim/drives/sim_drive.hpp"

namespace fvd::sim {

/// | 0x0000..0x01FF | parameters in pairs, the low word at the odd address: 0x0001 pulses per turn, 0x000F enable     |
/// | 0x1003         | status: bit 0 fault, 1 enabled, 2 running, 4 command done, 5 path done, 6 homed                 |
/// | 0x1012, 0x1014 | command and feedback position, pulses                                                           |
/// | 0x1801, 0x1901 | control word: 0x1111 resets the alarm, 0x2211 saves, 0x4001/0x4002 jog; 0x5555 = saved          |
/// | 0x2203         | present alarm                                                                                   |
/// | 0x6000..0x602F | bit 1 of 0x6000 software limits on, + 0x6006, - 0x6008; other PR settings, kept                 |
/// | 0x6002         | <- 0x10 + n starts path n, 0x20 homing, 0x21 the axis stands at 0, 0x40 quick stop; reads       |
/// |                | 0x0n done, 0x010n running, 0x20 homing                                                          |
/// | 0x6200 + 8n    | path n: mode, position (2), speed rpm, acceleration and deceleration ms per 1000 rpm, pause,    |
/// |                | and in path 0 alone a word that is 0x6002 itself: the start in the same frame                   |
///
/// Modes of a path: bits 0-3: 1 position, 2 speed, 3 homing; bit 4: may interrupt a running one; bit 6: relative. A
/// parameter is written alone at its odd address or in blocks from an even one; else "illegal address", as outside.
///
/// Disabled at power-on: nothing moves before 0x000F = 1, without a word, nor in alarm. A start while a path runs is
/// ignored unless bit 4 allows it. Speed 0 moves nothing; an acceleration of 0 counts as 1. Moves before homing are
/// allowed. A jog must be written anew within 50 ms. Alarms: 0x260 limit (switch, or target beyond the software
/// limits), 0x570 torque off; both codes are not confirmed by a manual. What reading 0x6002 gives, and bit 4 of the
/// mode, are not either.
class LeadshineDrive final : public SimDrive {
 public:
  /// axis outlives the drive. pulses_per_rev: 0x0001 at power-on, 1..65535; writing it takes effect at once.
  explicit LeadshineDrive(AxisModel& axis, DriveClock clock = HostClock::now, int pulses_per_rev = 10000);

 private:
  void power_on() override;
  void refresh(HostTime now) override;
  void was_written(const Written& written, HostTime now) override;
  void was_read(int address, std::size_t count) override;
  void elapse(HostTime now) override;
  void on_alarm(HostTime now) override;
  void on_limit(HostTime now) override;
  void on_torque_off(HostTime now) override;
  [[nodiscard]] ModbusException may_read(int address, std::size_t count) const override;
  [[nodiscard]] ModbusException may_write(int address, std::span<const std::uint16_t> values) const override;

  void trigger(unsigned command, HostTime now);
  void start_path(int path, HostTime now);
  void start_position(int at, unsigned mode, double speed, HostTime now);
  void control(unsigned command, HostTime now);
  void jog(int direction, HostTime now);
  void halt(HostTime now);
  [[nodiscard]] bool enabled() const;
  [[nodiscard]] double steps_per_s(double rpm) const;
  [[nodiscard]] double steps_per_s2(double ms_per_1000_rpm) const;

  const int pulses_per_rev_;
  int path_ = 0;         // the last one started
  bool homing_ = false;  // rather than a path
  std::optional<HostTime> jog_until_;
};

}  // namespace fvd::sim
