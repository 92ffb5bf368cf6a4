#pragma once

/// Whether an axis has its reference, asked only where that is not known.

#include "core/base/clock.hpp"
#include "core/hw/axis.hpp"

namespace fvd {

/// An axis that is sampled all the time and had it a moment ago is not asked: an answer takes some milliseconds of a
/// serial line, between a trigger and the first motion too. What happens since then is seen by the motion, which looks
/// itself before it begins (Axis::move_to). Throws Error kStageDisconnected.
[[nodiscard]] bool has_reference(Axis& stage, const Clock& clock);

}  // namespace fvd
