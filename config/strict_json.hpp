#pragma once

/// JSON as people write it: // comments allowed; duplicate keys, trailing text and deep nesting refused.

#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "config/problem.hpp"

namespace fvd {

/// Deeper documents are refused before anything recurses over them.
inline constexpr int kMaxJsonDepth = 32;

enum class JsonComments { kAllowed, kRefused };

/// The document, or nothing and one problem that says line and column.
[[nodiscard]] std::optional<nlohmann::json> parse_strict_json(std::string_view text, Problems& problems,
                                                              JsonComments comments = JsonComments::kAllowed);

/// What a document written by people may be long.
inline constexpr std::uintmax_t kMaxDocument_bytes = std::uintmax_t{1} << 20U;
/// For files of the program's own, which grow for as long as the instrument lives.
inline constexpr std::uintmax_t kAnyLength = std::numeric_limits<std::uintmax_t>::max();

/// The file's text. Throws Error kBadInput naming the file and the reason; longer files than most_bytes are refused.
[[nodiscard]] std::string read_text_file(const std::filesystem::path& file,
                                         std::uintmax_t most_bytes = kMaxDocument_bytes);

}  // namespace fvd
