#pragma once

/// The registers of an Oriental Motor AR-KD2 drive (AR series, Modbus RTU mode; addresses are PDU addresses, 32-bit
/// values high word first) on top of a simulated axis.

#include "sim/drives/sim_drive.hpp"

namespace fvd::sim {

/// | 0x007D         | driver input: bits 0-2 M0..M2 number of the data, 3 START, 4 HOME, 5 STOP, 6 FREE               |
/// | 0x007F         | driver output: bit 4 HOME-P, 5 READY, 7 ALM, 8 S-BSY, 13 MOVE, 14 END                           |
/// | 0x0080         | present alarm; 0x0180 <- 1 after 0 resets it                                                    |
/// | 0x00C6, 0x00CC | command and actual position, steps                                                              |
/// | 0x018A         | <- 1 after 0: preset, the axis stands at 0                                                      |
/// | 0x0386..0x038B | software limits: action (0 off, else alarm 0x67), + and - limit                                 |
/// | 0x0400..0x06FF | operation data: position 0x0400, speed 0x0480 (Hz), mode 0x0500 (0 incremental, 1 absolute),    |
/// |                | function 0x0580, acceleration 0x0600, deceleration 0x0680; data n at + 2n, n = 0..63            |
/// | 0x1200, 0x1202 | communication timeout, ms, 0 = off; communication error alarm, kept and without effect          |
///
/// Accelerations are in 0.001 kHz/s, that is steps/s^2, as the AZ's; a real AR gets this unit by parameter 0x028E.
///
/// START and HOME are edges that must be held for 4 ms; a shorter pulse is not seen, without a word. STOP and FREE act
/// at once and hold off all motion. Nothing starts while the axis moves, or in alarm. Moves before homing are allowed.
/// Other addresses below 0x0400 and in 0x1200..0x1203 keep what is written; the rest is refused.
///
/// Communication timeout: armed by a value above 0, without a request for that long the axis stops with alarm 0x85.
/// Alarms: 0x66 limit switch, 0x67 target beyond the software limits, 0x68 torque off (this code is the AZ's: the AR
/// has no such input). A power cycle loses the reference and what was written, as without saving to its memory.
class ArDrive final : public SimDrive {
 public:
  /// axis outlives the drive.
  explicit ArDrive(AxisModel& axis, DriveClock clock = HostClock::now);

  static constexpr HostClock::duration kMinHoldTime = std::chrono::milliseconds(4);

 private:
  void power_on() override;
  void refresh(HostTime now) override;
  void was_written(const Written& written, HostTime now) override;
  void elapse(HostTime now) override;
  void on_alarm(HostTime /*now*/) override {}
  void on_limit(HostTime now) override;
  void on_torque_off(HostTime now) override;

  void see_inputs(HostTime now);
  void watch_communication(HostTime now);
  void start_operation(HostTime now);
  [[nodiscard]] bool ready(HostTime now);
  [[nodiscard]] bool rises(int address, const Written& written, bool& was_set);

  unsigned level_ = 0;    // inputs as written
  unsigned pending_ = 0;  // START, HOME: risen and not yet held long enough
  HostTime risen_{};      // the last of them
  bool reset_set_ = false;
  bool preset_set_ = false;
};

}  // namespace fvd::sim
