#pragma once

/// Points of time as text, UTC to 1 s, whatever the machine's time zone.

#include <chrono>
#include <string>

namespace fvd {

/// "2026-11-29T17:00:28Z".
[[nodiscard]] std::string iso_time_text(std::chrono::system_clock::time_point time);

/// "2026-11-29 17:00:28 UTC".
[[nodiscard]] std::string people_time_text(std::chrono::system_clock::time_point time);

}  // namespace fvd
