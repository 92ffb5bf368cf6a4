#pragma once

/// Which files of a folder, or pages of a file, are the slices, and in which order.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace fvd {

/// The location of one slice: a file, and the page in it for a multi-page TIFF.
struct SliceLocation {
  std::filesystem::path file;
  std::optional<int> page;  ///< 0-based
  bool contiguous = false;  ///< page counts images that stand one after the other behind the only directory

  /// "slice_004.png", or "stack.tif page 4" with pages counted from 1 as viewers do.
  [[nodiscard]] std::string name() const;
};

/// What a person says about the slices beyond where they are; what is absent is found out.
struct StackChoice {
  std::string pattern;         ///< of the names in a folder, see NamePattern; empty: by the names themselves
  std::optional<int> channel;  ///< of pages that have several, from 1
  std::optional<int> time;     ///< likewise
};

struct SliceList {
  std::vector<SliceLocation> slices;  ///< in natural order: slice_2 before slice_10
  std::string description;            ///< e.g. "slice_*.png (31 files)"
  /// Set if the numbers in the names have a gap: "slice_007.png is followed by slice_009.png". Heights then cannot come
  /// from a constant step.
  std::string gap;
  std::string doubt;         ///< what a person should know of the order: a slice may be missing; empty: nothing
  std::vector<double> z_um;  ///< of each slice, as its name or page says with a unit; empty: they do not
  std::string z_from;        ///< what says it: "the names", "ImageJ's description"
  std::optional<double> pixel_pitch_x_um;  ///< distance of pixels on the object, where a page's description says it
  std::optional<double> pixel_pitch_y_um;
  int used_files = 0;
  std::vector<std::string> ignored;        ///< the other image files of the folder, by name; used + ignored = all
  int used_pages = 0;                      ///< of a multi-page TIFF
  std::vector<std::string> ignored_pages;  ///< its others, with the reason in brackets; used + ignored = all
};

/// source: a folder, or one multi-page TIFF file. The slices of a folder are the image files (PNG, TIFF, JPEG, PGM,
/// BMP) that match the pattern; without one the largest family of files whose names differ in numbers only, see
/// order_names(), or one multi-page TIFF if it has more pages than any family has files; which of its pages:
/// tiff_slices(). Other files are left alone and listed. Throws Error kBadInput if the path does not exist, holds no
/// stack or only one slice, has two files with the same number, or leaves a choice: a second candidate with more than
/// half the slices of the largest, further files whose names have the same words as the slices', with other numbers or
/// none, numbers that can be read in two ways. The message names the choices.
[[nodiscard]] SliceList find_slices(const std::filesystem::path& source, const StackChoice& choice = {});

}  // namespace fvd
