#pragma once

/// The wire from the drive's in-position output to the camera's trigger line.

#include <functional>
#include <stop_token>
#include <thread>

#include "sim/axis/axis_model.hpp"

namespace fvd::sim {

/// Polls the axis every 0.2 ms and calls `edge` whenever the axis has arrived in position. context: the edge is called
/// on a thread of its own.
class LineTrigger {
 public:
  /// axis outlives the trigger.
  LineTrigger(const AxisModel& axis, std::function<void()> edge);

 private:
  void watch(std::stop_token stop) const;

  const AxisModel& axis_;
  const std::function<void()> edge_;
  std::jthread thread_;
};

}  // namespace fvd::sim
