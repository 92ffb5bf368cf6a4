#pragma once

/// Measures that an axis stands still.

#include <functional>

#include "core/base/clock.hpp"
#include "core/hw/axis.hpp"

namespace fvd {

/// Looks at the axis until it stands still, half a second at most. An axis that moves is told to stop, once. Standstill
/// is two looks in a row at an axis that reports rest and measures the same position: a drive may report standstill
/// before it starts, or late. Returns false if the axis did not come to rest; it has been told to stop then.
/// on_motion: called at every look that sees motion. Throws Error kStageDisconnected.
/// context: the machine's thread.
[[nodiscard]] bool bring_to_rest(Axis& axis, Clock& clock, const std::function<void()>& on_motion);

}  // namespace fvd
