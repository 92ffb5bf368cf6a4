#include "drivers/common/alarm_reset.hpp"

#include <chrono>

#include "core/base/error.hpp"

namespace fvd {

void end_alarm(AxisPort& port, AxisPoller& poller, const std::stop_token& stop) {
  constexpr std::chrono::seconds kLongest{2};
  CommandResult sent;
  poller.pause([&] { sent = port.reset_alarm(stop); });
  const bool was_told = sent.outcome != CommandOutcome::kRefused;  // or may have been: its answer was lost
  const HostTime told = HostClock::now();
  for (HostTime last = told;;) {
    const AxisSample sample = poller.sample_after(last, stop);
    if (!sample.alarm) return;
    last = sample.begun;
    if (was_told && sample.time - told < kLongest) continue;
    throw Error(
        ErrorCode::kStageAlarm,
        "the drive at " + port.traits().address + " keeps its " + port.alarm_text(sample.alarm_code) +
            (was_told ? " although it was told to end it" : ", and could not be told to end it: " + sent.error) +
            "; see to the cause by its manual, then reset again, or switch it off and on");
  }
}

}  // namespace fvd
