#pragma once

/// The registers of an Oriental Motor AZ drive (HM-60262-6E; addresses are PDU addresses, 32-bit values high word
/// first) on top of a simulated axis.

#include "sim/drives/sim_drive.hpp"

namespace fvd::sim {

/// | 0x0058..0x0069 | direct data operation: number, type, position, speed, rates, current, trigger, destination |
/// | 0x0078/79      | driver input, automatic OFF: bit 4 HOME, 5 STOP, 7 ALM-RST                                 |
/// | 0x007C/7D      | driver input, level: the same bits, bit 6 FREE                                             |
/// | 0x007E/7F      | driver output: bit 4 HOME-END, 5 READY, 7 ALM-A, 8 SYS-BSY, 13 MOVE, 14 IN-POS               |
/// | 0x0080/81      | present alarm; 0x0180/81 <- 1 resets it                                                    |
/// | 0x00C6, 0x0122 | command position; 0x00CC, 0x0120 actual (encoder) position, steps                          |
/// | 0x00F8, 0x00FA | driver and motor temperature, 0.1 degC                                                     |
/// | 0x0178..0x017F | output image independent of the assignment of signals                                      |
/// | 0x018A         | <- 1: position preset, the axis stands at 0x038C                                           |
/// | 0x0386..0x038B | software overtravel: action (-1 off, 1 stop), + and - limit                                |
///
/// Other addresses below 0x0400 read as 0 and keep what is written, above are refused. A move is ignored without a word
/// when the drive is not READY, as the real one does; a running absolute move may be given another target. Moves before
/// homing are allowed. Alarms: 0x66 on a limit switch, 0x67 for a target beyond the software limits, 0x68 when torque
/// is taken away (HWTO). A power cycle loses the reference, as without a home position in the absolute encoder.
class AzDrive final : public SimDrive {
 public:
  /// axis outlives the drive.
  explicit AzDrive(AxisModel& axis, DriveClock clock = HostClock::now);

 private:
  void power_on() override;
  void refresh(HostTime now) override;
  void was_written(const Written& written, HostTime now) override;
  void on_alarm(HostTime /*now*/) override {}
  void on_limit(HostTime now) override;
  void on_torque_off(HostTime now) override;

  void act_on_direct_data(const Written& written, HostTime now);
  void act_on_inputs(unsigned rising, HostTime now);
  void start_direct_operation(HostTime now);
  [[nodiscard]] bool leaves_limits(std::int64_t target, HostTime now);

  unsigned level_ = 0;  // the inputs that were last seen
};

}  // namespace fvd::sim
