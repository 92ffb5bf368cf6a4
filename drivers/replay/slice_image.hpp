#pragma once

/// Decoding of one recorded slice.

#include <cstdint>
#include <filesystem>
#include <vector>

#include "core/image/image.hpp"
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

/// Reads 8 or 16 bit, grey or colour, into `slice`, whose memory it reuses. Sharpness is measured in the luminance:
/// colour becomes Y = 0.299 R + 0.587 G + 0.114 B (ITU-R BT.601), an alpha channel is ignored. 16-bit files are Mono16,
/// except a PGM, whose largest grey level may mean Mono10 or Mono12. Throws Error kBadInput, naming the file, if it is
/// unreadable, corrupt or truncated, of another kind of pixel, or a multi-page file where one slice was expected;
/// `slice` is then undefined.
void read_slice(const SliceLocation& location, SliceImage& slice);

}  // namespace fvd
