#pragma once

/// Values of the JSON files: rounded, and null where unknown. Only sources of this folder include it: it includes
/// nlohmann/json.

#include <chrono>
#include <optional>
#include <string>

#include <nlohmann/json.hpp>

namespace fvd {

/// null where the text is empty.
[[nodiscard]] nlohmann::ordered_json text_or_null(const std::string& text);

/// The value rounded to this number of decimals; null where it is unknown or not finite.
[[nodiscard]] nlohmann::ordered_json rounded(const std::optional<double>& value, int decimals);

/// "2026-11-23T14:05:59.123Z".
[[nodiscard]] std::string iso8601_utc(std::chrono::system_clock::time_point time);

/// The time that iso8601_utc() wrote; nothing for any other text.
[[nodiscard]] std::optional<std::chrono::system_clock::time_point> from_iso8601_utc(const std::string& text);

}  // namespace fvd
