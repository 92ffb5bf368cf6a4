#pragma once

/// Which pages of a TIFF are slices.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "drivers/replay/slice_files.hpp"

namespace fvd {

/// A page that is none of the images: a reduced one, or a mask.
struct LeftOutPage {
  int page = 0;  ///< 0-based
  std::string reason;
};

/// What stands in a TIFF.
struct TiffContent {
  std::vector<int> images;  ///< directories of the full images, 0-based, in order
  std::vector<LeftOutPage> left_out;
  std::string description;   ///< ImageDescription of the first image
  int samples_per_page = 1;  ///< of a pixel of the first image
  /// Images that stand one after the other behind the only directory, as ImageJ writes stacks above 4 GB; 0 for any
  /// other file. -1: it should, but the file is too short for them.
  int contiguous = 0;

  /// Images of the file, before channels and times are told apart.
  [[nodiscard]] int size() const { return contiguous > 1 ? contiguous : static_cast<int>(images.size()); }
};

/// Empty if the file is missing or no TIFF. Reduced images and masks are known by NewSubfileType, SubfileType and
/// PhotometricInterpretation (TIFF 6.0).
[[nodiscard]] TiffContent tiff_content(const std::filesystem::path& file);

/// The stack that the pages make, with its z where the description tells it.
/// Throws Error kBadInput, naming what there is, if the description tells of several channels or times and `choice`
/// does not say which one, or says one that is not there; if it does not fit the pages; if there is one slice only.
[[nodiscard]] SliceList tiff_slices(const std::filesystem::path& file, const StackChoice& choice);

}  // namespace fvd
