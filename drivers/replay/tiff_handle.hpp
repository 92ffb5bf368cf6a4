#pragma once

/// Opening a TIFF with libtiff, quietly.

#include <filesystem>
#include <memory>
#include <string>

#include <tiffio.h>

namespace fvd {

struct TiffCloser {
  void operator()(TIFF* tiff) const noexcept { TIFFClose(tiff); }
};
using Tiff = std::unique_ptr<TIFF, TiffCloser>;

/// Null if the file is none. error: where the handle's errors go; must outlive it.
[[nodiscard]] Tiff open_tiff(const std::filesystem::path& file, std::string& error);

/// The layout of one page, as its tags say.
struct TiffPage {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::uint16_t bits = 1;
  std::uint16_t samples = 1;
  std::uint16_t sample_format = SAMPLEFORMAT_UINT;
  std::uint16_t planes = PLANARCONFIG_CONTIG;
  std::uint16_t photometric = PHOTOMETRIC_MINISBLACK;
  std::uint16_t compression = COMPRESSION_NONE;

  [[nodiscard]] int channels() const { return photometric == PHOTOMETRIC_RGB && samples >= 3 ? 3 : 1; }
  /// Whether samples are grey levels or red, green and blue.
  [[nodiscard]] bool direct() const {
    return photometric == PHOTOMETRIC_MINISBLACK || photometric == PHOTOMETRIC_MINISWHITE ||
           (photometric == PHOTOMETRIC_RGB && samples >= 3);
  }
};

/// Of the handle's present directory.
[[nodiscard]] TiffPage page_of(TIFF* tiff);

}  // namespace fvd
