#pragma once

/// Date and time within a file name.

#include <cstddef>
#include <optional>
#include <string>

namespace fvd {

struct TimeStamp {
  std::size_t position = 0;  ///< of its first character
  std::size_t length = 0;
  double seconds = 0.0;  ///< since 1970, time zone ignored
};

/// "20261123_120001", "2026-11-23T12-00-01", "2026-11-23 at 12.00.01", "20261123120001250" (with milliseconds): a date
/// and a time to the second.
[[nodiscard]] std::optional<TimeStamp> find_time_stamp(const std::string& name);

}  // namespace fvd
