#pragma once

/// errno of a file operation as the program's error.

#include <filesystem>
#include <string_view>

#include "core/base/error.hpp"

namespace fvd {

/// kStorageFull for ENOSPC and EDQUOT, else kStorageWrite; the message is "cannot <action> <path>: <text of errno>".
[[nodiscard]] Error storage_error(int error_number, std::string_view action, const std::filesystem::path& path);

}  // namespace fvd
