#pragma once

/// Where a list of jobs goes on: a text that a client gives back as it came.

#include <cstddef>
#include <cstdint>
#include <string>

namespace fvd {

/// Longest cursor.
inline constexpr std::size_t kLongestCursor_bytes = 32;

/// next: as JobPage::next; empty for 0.
[[nodiscard]] std::string job_cursor(std::int64_t next);

/// The `before` that the cursor stands for; 0 for an empty one. Throws ProtocolError for any text that job_cursor()
/// does not make.
[[nodiscard]] std::int64_t before_of_cursor(const std::string& cursor);

}  // namespace fvd
