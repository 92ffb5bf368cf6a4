#include "core/scan/reference.hpp"

#include <chrono>
#include <optional>

namespace fvd {

namespace {

/// An axis that is sampled all the time is sampled some times within this.
constexpr std::chrono::milliseconds kMoment{200};

}  // namespace

bool has_reference(Axis& stage, const Clock& clock) {
  const std::optional<StageStatus> seen = stage.last_seen();
  const bool is_known =
      seen && seen->homed && seen->state != AxisState::kCommLost && clock.now() - seen->sampled <= kMoment;
  // One that was seen without may have got it since: the end of a homing is later than the sample that told it.
  return is_known || stage.status().homed;
}

}  // namespace fvd
