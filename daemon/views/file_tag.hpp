#pragma once

/// What tells one state of a file from another, for entity tags.

#include <filesystem>
#include <string>

#include <sys/stat.h>

namespace fvd {

/// Time of change, size and number of the file in hexadecimal digits: another text once the file is replaced.
[[nodiscard]] std::string file_tag(const struct stat& status);

/// Of the file itself, where it is a link too. Throws Error kSurfaceFile where there is none.
[[nodiscard]] std::string file_tag(const std::filesystem::path& path);

}  // namespace fvd
