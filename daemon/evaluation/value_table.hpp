#pragma once

/// Every value that a measurement can give: its name, unit, meaning and where that is defined.

#include <span>
#include <string>
#include <string_view>

namespace fvd {

struct ValueMeaning {
  std::string_view kind;     ///< of the measurement
  std::string_view key;      ///< "Sa_um"; of levels "UPPER-LOWER_um"
  std::string_view meaning;  ///< for people
  std::string_view defined;  ///< standard with edition and clause, or "own definition"
};

/// All of them, by kind, in the order in which results have them.
[[nodiscard]] std::span<const ValueMeaning> value_meanings() noexcept;

/// The same as a table in Markdown; the unit is that of the key.
[[nodiscard]] std::string values_markdown();

}  // namespace fvd
