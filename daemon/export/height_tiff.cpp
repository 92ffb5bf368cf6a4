#include "daemon/export/height_tiff.hpp"

#include <algorithm>
#include <memory>
#include <sstream>

#include <tiffio.h>
#include <tiffio.hxx>

#include "core/error.hpp"

namespace fvd {

namespace {

struct TiffCloser {
  void operator()(TIFF* tiff) const noexcept { TIFFClose(tiff); }
};

constexpr double kMicrometresPerCentimetre = 1e4;

void set_tags(TIFF* tiff, const Plane<float>& height_m, const TiffTags& tags) {
  TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, static_cast<std::uint32_t>(height_m.width()));
  TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, static_cast<std::uint32_t>(height_m.height()));
  TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, 1);
  TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, 32);
  TIFFSetField(tiff, TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_IEEEFP);
  TIFFSetField(tiff, TIFFTAG_COMPRESSION, COMPRESSION_NONE);
  TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
  TIFFSetField(tiff, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
  TIFFSetField(tiff, TIFFTAG_ORIENTATION, ORIENTATION_TOPLEFT);
  TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, TIFFDefaultStripSize(tiff, 0));
  TIFFSetField(tiff, TIFFTAG_SOFTWARE, tags.software.c_str());
  TIFFSetField(tiff, TIFFTAG_IMAGEDESCRIPTION, tags.description.c_str());
  if (tags.pitch_x_um && tags.pitch_y_um) {
    TIFFSetField(tiff, TIFFTAG_RESOLUTIONUNIT, RESUNIT_CENTIMETER);
    TIFFSetField(tiff, TIFFTAG_XRESOLUTION, kMicrometresPerCentimetre / *tags.pitch_x_um);
    TIFFSetField(tiff, TIFFTAG_YRESOLUTION, kMicrometresPerCentimetre / *tags.pitch_y_um);
  }
}

}  // namespace

std::string encode_height_tiff(const Plane<float>& height_m, const TiffTags& tags) {
  std::ostringstream bytes;
  const std::unique_ptr<TIFF, TiffCloser> tiff(TIFFStreamOpen("height map", &bytes));
  if (!tiff) throw Error(ErrorCode::kInternal, "libtiff cannot write to memory");
  set_tags(tiff.get(), height_m, tags);
  Plane<float> row(height_m.width(), 1);  // libtiff wants a row it may change
  for (int y = 0; y < height_m.height(); ++y) {
    std::copy_n(height_m.row(y), height_m.width(), row.row(0));
    if (TIFFWriteScanline(tiff.get(), row.row(0), static_cast<std::uint32_t>(y), 0) != 1) {
      throw Error(ErrorCode::kInternal, "libtiff refused row " + std::to_string(y) + " of the height map");
    }
  }
  if (TIFFFlush(tiff.get()) != 1) throw Error(ErrorCode::kInternal, "libtiff could not finish the height map");
  return std::move(bytes).str();
}

}  // namespace fvd
