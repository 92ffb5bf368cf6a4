#pragma once

/// JSON as people write it: // comments allowed; duplicate keys, trailing text and deep nesting refused.

#include <filesystem>
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

/// The file's text. Throws Error kBadInput naming the file and the reason; files over 1 MiB are refused.
[[nodiscard]] std::string read_text_file(const std::filesystem::path& file);

}  // namespace fvd
