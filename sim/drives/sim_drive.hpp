#pragma once

/// The part that all simulated drives share: the axis, an alarm, faults, the lock.

#include <atomic>
#include <cstdint>
#include <functional>
#include <span>

#include "core/base/clock.hpp"
#include "core/base/mutex.hpp"
#include "sim/axis/axis_model.hpp"
#include "sim/modbus/drive_faults.hpp"
#include "sim/modbus/register_bank.hpp"
#include "sim/modbus/register_image.hpp"

namespace fvd::sim {

/// The clock of a drive; tests pass their own.
using DriveClock = std::function<HostTime()>;

/// context: thread-safe; a derived class is called under the lock and takes none.
class SimDrive : public RegisterBank, public DriveFaults {
 public:
  [[nodiscard]] ModbusException read(int address, std::span<std::uint16_t> values) final;
  [[nodiscard]] ModbusException write(int address, std::span<const std::uint16_t> values) final;
  void idle() final;

  void raise_alarm(int code) final;
  void limit_hit() final;
  void emergency_stop() final;
  void power_cycle() final;
  void refuse_moves(int count) final;
  void hold_in_position(HostClock::duration duration) final;
  void exchange_words(bool exchanged) final;
  [[nodiscard]] bool axis_moves() final;

  /// The drive is set up to give and take the low word of 32-bit values first; to be called before its first request.
  void set_low_word_first();

  /// Whatever raises an alarm stands from now on: a reset does not end it.
  void keep_alarms() { keeps_alarms_ = true; }

  [[nodiscard]] int moves() const noexcept { return moves_; }  ///< moves to a target executed so far

 protected:
  /// axis outlives the drive. The derived constructor lays out the image and calls power_on().
  SimDrive(AxisModel& axis, DriveClock clock) : axis_(axis), clock_(std::move(clock)) {}

  // What a map of registers is made of. `now` never runs back.
  virtual void power_on() = 0;                                         ///< writes the defaults into the empty image
  virtual void refresh(HostTime now) = 0;                              ///< writes present values into the image
  virtual void was_written(const Written& written, HostTime now) = 0;  ///< acts on a write, which is in the image
  virtual void was_read(int /*address*/, std::size_t /*count*/) {}     ///< resets registers that reading resets
  virtual void elapse(HostTime /*now*/) {}                             ///< what the drive does on its own up to `now`
  virtual void on_alarm(HostTime now) = 0;                             ///< alarm() was set and the axis stopped
  virtual void on_limit(HostTime now) = 0;                             ///< the axis was stopped on a limit switch
  virtual void on_torque_off(HostTime now) = 0;                        ///< the axis was stopped
  /// Beyond the image's areas; both default to "illegal address" where the image refuses.
  [[nodiscard]] virtual ModbusException may_read(int address, std::size_t count) const;
  [[nodiscard]] virtual ModbusException may_write(int address, std::span<const std::uint16_t> values) const;

  [[nodiscard]] RegisterImage& image() {
    mutex_.assert_held();
    return image_;
  }
  [[nodiscard]] const RegisterImage& image() const {
    mutex_.assert_held();
    return image_;
  }
  [[nodiscard]] AxisModel& axis() { return axis_; }

  [[nodiscard]] int alarm() const {
    mutex_.assert_held();
    return alarm_;
  }
  void set_alarm(int code) {
    mutex_.assert_held();
    if (code != 0 || !keeps_alarms_) alarm_ = code;
  }

  // What the drive reports: a fault may hold it.
  [[nodiscard]] bool reports_motion(HostTime now) const;
  [[nodiscard]] bool reports_in_position(HostTime now) const;
  [[nodiscard]] std::int32_t command_position(HostTime now) const;  ///< steps
  [[nodiscard]] std::int32_t actual_position(HostTime now) const;   ///< steps, from the encoder
  /// Makes the present position `position`, in steps, from `now` on.
  void preset_position(HostTime now, std::int32_t position);

  /// False if nothing starts, because a value is out of range (speed in steps/s, accelerations in steps/s^2, all > 0)
  /// or a fault refuses it. target: steps.
  bool start_move(HostTime now, std::int64_t target, double speed, double acceleration, double deceleration);
  bool start_home(HostTime now);

  /// Time of the request before this one; time of power-on if there was none.
  [[nodiscard]] HostTime last_request() const {
    mutex_.assert_held();
    return last_request_;
  }

 private:
  [[nodiscard]] bool is_held(HostTime now) const FVD_REQUIRES(mutex_) { return now < held_until_; }
  [[nodiscard]] bool refuses_start() FVD_REQUIRES(mutex_);
  HostTime time_passes() FVD_REQUIRES(mutex_);

  AxisModel& axis_;
  DriveClock clock_;
  Mutex mutex_;
  RegisterImage image_ FVD_GUARDED_BY(mutex_);
  bool low_word_first_ FVD_GUARDED_BY(mutex_) = false;
  int alarm_ FVD_GUARDED_BY(mutex_) = 0;
  std::atomic<bool> keeps_alarms_{false};
  int refused_starts_ FVD_GUARDED_BY(mutex_) = 0;
  std::int64_t offset_ FVD_GUARDED_BY(mutex_) = 0;  // what the drive calls a position, minus what the axis calls it
  HostTime held_until_ FVD_GUARDED_BY(mutex_) = HostTime::min();
  HostTime last_request_ FVD_GUARDED_BY(mutex_) = HostTime::max();
  std::atomic<int> moves_{0};
};

}  // namespace fvd::sim
