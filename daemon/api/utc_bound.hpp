#pragma once

/// Moments that a caller gives as the first or the last of a time.

#include <string>
#include <string_view>

namespace fvd {

/// The moment as JobStatus::ended_utc is written. text: "2026-11-30T10:00:00.000Z", or without milliseconds; empty
/// stays empty. name: the parameter's. Throws ProtocolError for any other text, and for a day or time that there is
/// not.
[[nodiscard]] std::string first_moment(std::string_view name, const std::string& text);
/// Likewise; without milliseconds the last of that second.
[[nodiscard]] std::string last_moment(std::string_view name, const std::string& text);

}  // namespace fvd
