#pragma once

/// The text file with a height for each slice.

#include <filesystem>
#include <string_view>
#include <vector>

namespace fvd {

/// The numbers of the file in its own unit; see ZFile for the format. unit: "um", "mm", "m", as which they will be
/// read. Throws Error kBadInput with file and line: unreadable, not one finite number, a comma that may be a decimal
/// comma or one of thousands, a header that says another unit.
[[nodiscard]] std::vector<double> read_z_list(const std::filesystem::path& file, std::string_view unit);

}  // namespace fvd
