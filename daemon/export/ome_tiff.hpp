#pragma once

/// A focus stack as an OME-TIFF: a page for each slice.

#include <cstdint>
#include <filesystem>
#include <functional>

#include "core/image/image.hpp"
#include "daemon/export/ome_xml.hpp"

namespace fvd {

/// Gives the pixels of one slice, which stay as they are until the next is asked for.
using SliceSource = std::function<ImageView(int index)>;

/// Files that may become larger are BigTIFF; offsets of the classic format end at 4 GiB.
inline constexpr std::uint64_t kClassicTiff_bytes = 4'000'000'000;

/// Writes a file that must not exist yet and brings it to the disk: uncompressed grey pages in the machine's byte
/// order, the levels as the slices have them, ome_xml() in the first page. Asks for each slice once, in order, and
/// keeps none: memory of one slice. A file that could not be finished is removed. stack: at least one slice; source
/// gives images of its size and format. Throws Error kStorageFull, kStorageWrite, and what source throws.
void write_ome_tiff(const std::filesystem::path& file, const OmeStack& stack, const SliceSource& source,
                    std::uint64_t classic_bytes = kClassicTiff_bytes);

}  // namespace fvd
