#pragma once

/// What programmers of a client get wrong before the first line is understood, told in a sentence.

#include <optional>
#include <string_view>

namespace fvd {

/// How a line ends.
enum class LineEnd { kNone, kNul, kBreak };

/// The mistake that shows in a line, or in the beginning of one whose end has not come (kNone): UTF-16, or a length
/// before the text. Nothing for all else. No line of JSON text is taken for a mistake.
[[nodiscard]] std::optional<std::string_view> mistake_in(std::string_view line, LineEnd end) noexcept;

/// The mistake of a line whose end does not come.
[[nodiscard]] std::string_view missing_end(std::string_view line);

}  // namespace fvd
