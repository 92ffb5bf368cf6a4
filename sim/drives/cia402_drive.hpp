#pragma once

/// The process image of a Nanotec drive with CiA 402 objects on Modbus (PD4-E, C5-E and N5 manuals, "Modbus process
/// data": default mapping; PDU addresses, 32-bit values high word first) on top of a simulated axis.

#include <optional>

#include "sim/drives/sim_drive.hpp"

namespace fvd::sim {

/// | written: 6000 | controlword 6040h                | read: 5000 | statusword 6041h                        |
/// | 6001          | mode 6060h in the low byte       | 5001       | mode display 6061h in the low byte      |
/// | 6002          | target position 607Ah, i32       | 5002       | position actual value 6064h, i32        |
/// | 6004          | profile velocity 6081h, u32      | 5004       | velocity actual value 6044h, always 0   |
/// | 6006          | vl velocity 6042h, kept          | 5005       | inputs 60FDh: bit 0 and 1, limits - and + |
/// | 6007          | outputs 60FEh, kept              | 5007       | error code 603Fh (*)                    |
/// | 6009, 6011    | profile acceleration 6083h and deceleration 6084h, u32 (*)                               |
///
/// (*) Not in the default mapping: added to it, as 3502h and 3602h allow. What is written can be read back. Positions
/// are user units of one step, velocities of one step/s (60A8h, 60A9h set to that).
///
/// State machine and modes of CiA 402: 1 profile position with set-point handshake (bit 4, bit 12), one set-point
/// buffered unless bit 5 asks for at once, bit 6 relative, bit 8 halt and go on; 6 homing. Other modes are not taken
/// over into the mode display. A set-point counts only in "operation enabled", also before homing. Quick stop ends in
/// "switch on disabled" once the axis stands (605Ah = 2). Target reached is stale during the axis' start latency.
/// A limit switch is no fault: the axis stops, bit 11 and an input say so until the next motion. Torque off (STO) leads
/// to "switch on disabled". An alarm is a fault with the code in 603Fh; the rising edge of bit 7 resets it.
class Cia402Drive final : public SimDrive {
 public:
  /// axis outlives the drive.
  explicit Cia402Drive(AxisModel& axis, DriveClock clock = HostClock::now);

  /// Of the simulated drives this one alone has it, as those of the map's maker may.
  [[nodiscard]] std::optional<DeviceIdentification> identification() const override {
    return DeviceIdentification{.vendor = "fvd", .product = "simulated CiA 402 drive", .revision = "1.0"};
  }

 private:
  enum class State { kSwitchOnDisabled, kReadyToSwitchOn, kSwitchedOn, kOperationEnabled, kQuickStopActive, kFault };

  struct SetPoint {
    std::int64_t target = 0;
    bool relative = false;
    double speed = 0.0;
    double acceleration = 0.0;
    double deceleration = 0.0;
  };

  void power_on() override;
  void refresh(HostTime now) override;
  void was_written(const Written& written, HostTime now) override;
  void elapse(HostTime now) override;
  void on_alarm(HostTime now) override;
  void on_limit(HostTime now) override;
  void on_torque_off(HostTime now) override;

  void control(unsigned word, HostTime now);
  void change_state(unsigned word, HostTime now);
  void leave_operation(State next, HostTime now);
  void position_mode(unsigned word, unsigned rising, unsigned falling, HostTime now);
  void take_set_point(unsigned word, HostTime now);
  void start(const SetPoint& set_point, HostTime now);
  void home(HostTime now);
  [[nodiscard]] unsigned statusword(HostTime now);

  State state_ = State::kSwitchOnDisabled;
  unsigned control_ = 0;  // the controlword before
  unsigned mode_ = 0;
  bool acknowledged_ = false;
  bool internal_limit_ = false;
  int direction_ = 1;  // of the last set-point
  std::optional<SetPoint> running_;
  std::optional<SetPoint> buffered_;
  bool halted_ = false;  // running_ goes on when halt is taken back
  HostTime home_since_{};
};

}  // namespace fvd::sim
