#pragma once

/// A file in place of another.

#include <cstdint>
#include <filesystem>
#include <string_view>

#include "daemon/export/durable_file.hpp"

namespace fvd {

/// Writes a file in place of what is there under its name, which is there or the new one, whole, whatever happens.
/// Returns its size in bytes. Throws Error kStorageFull, kStorageWrite, and what `produce` throws.
std::uint64_t replace_file(const std::filesystem::path& path, const ByteProducer& produce);
void replace_file(const std::filesystem::path& path, std::string_view bytes);

}  // namespace fvd
