#pragma once

/// Ends a motion: a stop, and a standstill that was measured.

#include <string>

#include "drivers/common/axis_poller.hpp"
#include "drivers/common/axis_port.hpp"

namespace fvd {

/// Standstill is what RestDetector finds in the samples. An axis without torque counts as reporting no motion: some
/// drives say "target reached" only while they are enabled.
/// context: thread-safe.
class AxisStopper {
 public:
  /// limits: of all moves; they tell how long the axis brakes. Port and poller outlive the stopper.
  AxisStopper(AxisPort& port, AxisPoller& poller, const MotionLimits& limits);

  /// Sends the stop up to three times, until the controller has taken it; to one that was busy for as long as it
  /// may be, once. Empty, or why it was not taken.
  std::string send() noexcept;

  /// Sends the stop and waits for the standstill, two seconds longer than braking takes at most. Empty when the
  /// standstill was measured; else a sentence "standstill was not confirmed: ...".
  std::string halt() noexcept;

  /// halt(), if the axis moved in the last sample; the log tells what came of it.
  void halt_if_moving() noexcept;

  /// False at the first sample that shows motion. Throws Error kStageDisconnected.
  [[nodiscard]] bool rests();

 private:
  bool wait_for_standstill(HostTime deadline, bool patient);

  AxisPort& port_;
  AxisPoller& poller_;
  const std::chrono::milliseconds timeout_;
};

}  // namespace fvd
