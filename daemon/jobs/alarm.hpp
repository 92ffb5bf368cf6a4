#pragma once

/// A line of the log that somebody has to see.

#include <cstdint>
#include <string>
#include <string_view>

namespace fvd {

enum class AlarmLevel { kWarning, kError, kCritical };

/// "warning", "error", "critical".
[[nodiscard]] constexpr std::string_view alarm_level_name(AlarmLevel level) noexcept {
  switch (level) {
    case AlarmLevel::kWarning:
      return "warning";
    case AlarmLevel::kError:
      return "error";
    case AlarmLevel::kCritical:
      return "critical";
  }
  return "critical";
}

struct Alarm {
  std::int64_t number = 0;  ///< counts them since the start, from 1
  std::string time_utc;     ///< when it was told first: "2026-11-30T10:00:00.000Z"
  std::string last_utc;     ///< and last
  AlarmLevel level = AlarmLevel::kWarning;
  std::string text;        ///< UTF-8, at most AlarmLog::kLongestText_bytes
  std::int64_t count = 1;  ///< so often
  bool acknowledged = false;
};

}  // namespace fvd
