#pragma once

/// The registers of an Applied Motion ST/STM drive, SCL over Modbus (920-0176 Rev A; PDU address = 4xxxx - 40001;
/// 32-bit values high word first, that is PR=5) on top of a simulated axis.

#include <deque>

#include "sim/drives/sim_drive.hpp"

namespace fvd::sim {

/// | 0       | alarm mask: bit 0 position error, 1 and 2 CCW and CW limit, 3 over-temperature, 12 move while disabled |
/// | 1       | status: bit 0 enabled, 2 fault, 3 in position, 4 moving, 9 alarm, 10 homing                            |
/// | 3       | inputs, 0                                                                                              |
/// | 4, 6, 8 | encoder position, immediate command position, target of the last move, steps                           |
/// | 12, 14  | drive temperature, 0.1 degC; position error                                                            |
/// | 27, 28  | AC, DE: 1..32767 of 1/6 rps^2                                                                          |
/// | 29, 30  | VE: 1..32000 of 1/240 rps; DI: distance or target, steps                                               |
/// | 52      | EG/2: half the steps per turn                                                                          |
/// | 124     | opcode, parameters in 125..129                                                                         |
///
/// Opcodes: 0x9F enable, 0x9E disable, 0x66 relative move (FL), 0x67 absolute move (FP), 0x6E seek home (SH), 0xDB find
/// home (FH), 0xE1 and 0xE2 stop, 0xBA alarm reset (AX), 0xA5 set position (SP, value in 125/126), 0x98 set encoder
/// position (EP, accepted, without effect: SP does both). Exceptions: 0x11 not readable, 0x12 not writable, 0x13 value
/// out of range; the whole write is refused then.
///
/// Enabled at power-on. Moves are buffered: one that comes while another runs starts when that has ended; a stop
/// empties the buffer. There is no bit for "homed"; the axis stands at 0 when homing has ended, as with SP0 in the
/// drive's own program. Moves before homing are allowed. Alarms hold off all motion until AX. Position error,
/// over-temperature, the voltages, over-current and encoder are faults: they disable the drive, and AX does not enable
/// it again. Torque off (STO) disables without an alarm; a limit switch sets bit 1 or 2 by the direction of the motion.
class SclDrive final : public SimDrive {
 public:
  /// axis outlives the drive. steps_per_rev: EG at power-on, 2..100000, even.
  explicit SclDrive(AxisModel& axis, DriveClock clock = HostClock::now, int steps_per_rev = 20000);

 private:
  void power_on() override;
  void refresh(HostTime now) override;
  void was_written(const Written& written, HostTime now) override;
  void elapse(HostTime now) override;
  void on_alarm(HostTime now) override;
  void on_limit(HostTime now) override;
  void on_torque_off(HostTime now) override;
  [[nodiscard]] ModbusException may_read(int address, std::size_t count) const override;
  [[nodiscard]] ModbusException may_write(int address, std::span<const std::uint16_t> values) const override;

  void execute(unsigned opcode, HostTime now);
  void start(unsigned opcode, HostTime now);
  void halt(HostTime now);

  const int steps_per_rev_;
  bool enabled_ = true;
  bool homing_ = false;
  int direction_ = 1;  // of the last move
  std::int64_t target_ = 0;
  std::deque<unsigned> buffered_;
};

}  // namespace fvd::sim
