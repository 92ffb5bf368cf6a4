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
  std::string doubt;         ///< where a slice may be missing, by the time in the names; empty: nowhere
  std::vector<double> z_um;  ///< of each slice, as its name says with a unit; empty: the names do not
  int used_files = 0;
  std::vector<std::string> ignored;  ///< the other image files of the folder, by name; used + ignored = all
};

/// source: a folder, or one multi-page TIFF file. pattern: of --pattern, see NamePattern; empty: by the names
/// themselves. The slices of a folder are the image files (PNG, TIFF, JPEG, PGM) that match the pattern; without one
/// the largest family of files whose names differ in numbers only, see order_names(), or one multi-page TIFF if it has
/// more pages than any family has files. Other files are left alone and listed. Throws Error kBadInput if the path does
/// not exist, holds no stack or only one slice, has two files with the same number, or leaves a choice: a second
/// candidate with more than half the slices of the largest, further files whose names have the same words as the
/// slices', numbers that can be read in two ways. The message names the choices.
[[nodiscard]] SliceList find_slices(const std::filesystem::path& source, const std::string& pattern = {});

}  // namespace fvd
