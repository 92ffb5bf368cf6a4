#pragma once

/// Measures that an axis stands still.

#include <functional>
#include <optional>

#include "core/base/clock.hpp"
#include "core/hw/axis.hpp"

namespace fvd {

/// Whether the axis says that it moves.
[[nodiscard]] bool reports_motion(const StageStatus& status);

/// Looks at the axis until it stands still by the drivers' own test (RestDetector), for a second at most. An axis that
/// moves is told to stop, once. Where it rests; nothing if it did not come to rest: it has been told to stop then.
/// on_motion: called at every look that sees motion. Throws Error kStageDisconnected. context: the machine's thread.
[[nodiscard]] std::optional<Micrometers> bring_to_rest(Axis& axis, Clock& clock,
                                                       const std::function<void()>& on_motion);

}  // namespace fvd
