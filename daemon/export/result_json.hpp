#pragma once

/// result.json: everything about a result except its pixels. Written here and read back here, nowhere else.

#include <string>
#include <string_view>
#include <vector>

#include "daemon/result/result.hpp"

namespace fvd {

/// Pretty-printed JSON, ASCII only, keys in a fixed order, null for whatever is unknown or not finite; heights rounded
/// to 0.1 nm. Holds the keys of format 1 as well.
[[nodiscard]] std::string result_json_text(const Result& result);

/// The text of a result with another list of files, and how long those took that followed; every other byte is kept.
/// text: as result_json_text() made it.
[[nodiscard]] std::string result_json_with_files(std::string_view text, const std::vector<ResultFile>& files,
                                                 double follow_ms);

/// What result_json_text() wrote, to its roundings; null where a number is expected reads as NaN. Throws Error
/// kBadInput with the JSON pointer of what is missing or wrong, and for another format.
[[nodiscard]] Result read_result_json(std::string_view text);

}  // namespace fvd
