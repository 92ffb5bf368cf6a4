#pragma once

/// The one thread that touches the devices: does the work that was posted, and looks after the devices in between.

#include <functional>
#include <optional>
#include <stop_token>
#include <thread>

#include "core/runtime/thread_ticks.hpp"
#include "daemon/devices/device_hub.hpp"
#include "daemon/jobs/machine_board.hpp"
#include "daemon/jobs/work_queue.hpp"

namespace fvd {

class MachineThread {
 public:
  /// in_between: called as often as the devices are looked after, never
  /// throws.
  MachineThread(DeviceHub& hub, MachineBoard& board, WorkQueue& work, ThreadTicks& ticks,
                std::function<void()> in_between);
  /// finish().
  ~MachineThread();
  /// Begins: opens the devices first. To be called once.
  void start();
  MachineThread(const MachineThread&) = delete;
  MachineThread& operator=(const MachineThread&) = delete;

  /// Asks the thread to end after the work that runs. context: any thread.
  void request_stop();
  /// Waits until the thread has ended and given the devices up, and refuses the work that still waits. context: one
  /// thread.
  void finish();

 private:
  void run(std::stop_token stop);
  /// False if a device is missing.
  bool look_after_devices();

  DeviceHub& hub_;
  MachineBoard& board_;
  WorkQueue& work_;
  ThreadTicks& ticks_;
  const std::function<void()> in_between_;
  int known_openings_ = 0;                   // of the devices that the board knows
  std::optional<DeviceFailure> told_alarm_;  // in the log; the board may have it from the end of a job or command
  std::jthread thread_;                      // last: ends before anything it uses
};

}  // namespace fvd
