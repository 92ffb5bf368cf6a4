#pragma once

/// Which files of a folder are the slices, and in which order.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace fvd {

/// The location of one slice: a file, and the page in it for a multi-page TIFF.
struct SliceLocation {
  std::filesystem::path file;
  std::optional<int> page;  ///< 0-based

  /// "slice_004.png", or "stack.tif page 4" with pages counted from 1 as viewers do.
  [[nodiscard]] std::string name() const;
};

struct SliceList {
  std::vector<SliceLocation> slices;  ///< in natural order: slice_2 before slice_10
  std::string description;            ///< e.g. "slice_*.png (31 files)"
  /// Set if the numbers in the names have a gap: "slice_007.png is followed by slice_009.png". Heights then cannot come
  /// from a constant step.
  std::string gap;
};

/// source: a folder, or one multi-page TIFF file. The slices of a folder are the largest family of image files (PNG,
/// TIFF, JPEG, PGM) whose names differ in their last number only, or one multi-page TIFF if it has more pages than any
/// family has files; other files are left alone. Two candidates of which the smaller has more than half the slices of
/// the larger are ambiguous.
/// Throws Error kBadInput if the path does not exist, holds no stack or only one slice, is ambiguous, or has two files
/// with the same number.
[[nodiscard]] SliceList find_slices(const std::filesystem::path& source);

}  // namespace fvd
