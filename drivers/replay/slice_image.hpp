#pragma once

/// Decoding of one recorded slice.

#include <cstdint>
#include <filesystem>
#include <vector>

#include "core/image/image.hpp"
#include "drivers/replay/image_file.hpp"
#include "drivers/replay/significant_bits.hpp"
#include "drivers/replay/slice_files.hpp"

namespace fvd {

/// An owned grey image, rows contiguous.
struct SliceImage {
  PixelFormat format = PixelFormat::kMono8;
  int width = 0;
  int height = 0;
  std::vector<std::byte> pixels;
  std::vector<std::uint8_t> colour;  ///< shape [height][width][3], blue, green, red, 8 bit each; empty for a grey file

  [[nodiscard]] ImageView view() const {
    return {format, width, height, static_cast<std::ptrdiff_t>(width) * bytes_per_pixel(format), pixels.data()};
  }
};

/// Decodes the file of one slice as it is, without a mapping of its levels. Throws Error kBadInput, naming the file, if
/// it is unreadable, corrupt or truncated, of another kind of pixel, or a multi-page file where one slice was expected;
/// `image` is then undefined. context: thread-safe for different images.
void decode_slice(const SliceLocation& location, ImageFile& image);

/// Reads grey or colour into `slice`, whose memory it reuses. Sharpness is measured in the luminance: colour becomes
/// Y = 0.299 R + 0.587 G + 0.114 B (ITU-R BT.601), an alpha channel is ignored. Throws as decode_slice(), and for
/// levels that the mapping has no place for; `slice` is then undefined.
void read_slice(const SliceLocation& location, const GreyMapping& mapping, SliceImage& slice);

/// Likewise, with a mapping of this slice alone.
void read_slice(const SliceLocation& location, SliceImage& slice);

/// The mapping that fits all slices: a few of them are looked at, all where these do not tell. significant_bits: see
/// GreySurvey. Throws as decode_slice().
[[nodiscard]] GreyMapping survey_slices(const std::vector<SliceLocation>& slices, int significant_bits);

}  // namespace fvd
