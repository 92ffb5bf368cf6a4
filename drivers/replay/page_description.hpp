#pragma once

/// What the description of a multi-page TIFF tells about its pages.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace fvd {

/// More pages than any stack has: a damaged description must not ask for all memory.
inline constexpr int kMaxPages = 1'000'000;

/// One page's place in the stack; all numbers 0-based.
struct PagePlace {
  int page = 0;  ///< see PageDescription::by_directory
  int z = 0;
  int channel = 0;
  int time = 0;
  std::optional<double> z_um;  ///< where it was recorded
};

struct PageDescription {
  std::string written_by;  ///< "OME-XML", "ImageJ": for messages
  int slices = 1;
  int channels = 1;
  int times = 1;
  std::vector<std::string> channel_names;  ///< empty where the description has none
  std::vector<PagePlace> pages;            ///< in any order
  bool by_directory = false;               ///< page counts all directories of the file; else those that hold an image
  std::optional<double> spacing_um;        ///< z from slice to slice; never 0
  std::optional<double> pixel_pitch_x_um;  ///< of pixels on the object; above 0
  std::optional<double> pixel_pitch_y_um;
  std::string problem;  ///< why the description cannot be used; empty if it can
};

/// ImageJ's "ImageJ=1.53t\nimages=42\nchannels=2\nslices=21\nspacing=10.0\nunit=um\n": channels change fastest, then
/// slices, then times. Nothing if the text is another one, or tells of one image only.
[[nodiscard]] std::optional<PageDescription> read_imagej_description(std::string_view text);

/// The OME-XML of an OME-TIFF (schema 2016-06): SizeZ, SizeC, SizeT, DimensionOrder, TiffData, the physical z.
/// filename: without folder, to leave out pages that stand in other files of a set. samples_per_page: of a pixel, so
/// that red, green and blue of one page are no channels. Nothing if the text is another one.
[[nodiscard]] std::optional<PageDescription> read_ome_description(std::string_view text, const std::string& filename,
                                                                  int samples_per_page);

/// The size in um of a unit of length as descriptions write it: um, micron, mm, cm, nm, m, inch and their like; 0 for
/// any other, such as pixel.
[[nodiscard]] double described_unit_um(std::string_view unit);

}  // namespace fvd
