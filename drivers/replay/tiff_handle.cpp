#include "drivers/replay/tiff_handle.hpp"

#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <new>

namespace fvd {

namespace {

int keep_error(TIFF* /*tiff*/, void* text, const char* /*module*/, const char* format, std::va_list arguments) {
  char line[160];
  std::vsnprintf(line, sizeof line, format, arguments);
  *static_cast<std::string*>(text) = line;
  return 1;  // not to standard error as well
}

int drop_warning(TIFF*, void*, const char*, const char*, std::va_list) { return 1; }  // of unknown tags, mostly

}  // namespace

Tiff open_tiff(const std::filesystem::path& file, std::string& error) {
  const std::unique_ptr<TIFFOpenOptions, decltype(&TIFFOpenOptionsFree)> options(TIFFOpenOptionsAlloc(),
                                                                                 TIFFOpenOptionsFree);
  if (!options) throw std::bad_alloc();
  TIFFOpenOptionsSetErrorHandlerExtR(options.get(), keep_error, &error);
  TIFFOpenOptionsSetWarningHandlerExtR(options.get(), drop_warning, nullptr);
  return Tiff(TIFFOpenExt(file.c_str(), "r", options.get()));
}

TiffPage page_of(TIFF* tiff) {
  TiffPage page;
  TIFFGetField(tiff, TIFFTAG_IMAGEWIDTH, &page.width);
  TIFFGetField(tiff, TIFFTAG_IMAGELENGTH, &page.height);
  TIFFGetFieldDefaulted(tiff, TIFFTAG_BITSPERSAMPLE, &page.bits);
  TIFFGetFieldDefaulted(tiff, TIFFTAG_SAMPLESPERPIXEL, &page.samples);
  TIFFGetFieldDefaulted(tiff, TIFFTAG_SAMPLEFORMAT, &page.sample_format);
  TIFFGetFieldDefaulted(tiff, TIFFTAG_PLANARCONFIG, &page.planes);
  TIFFGetField(tiff, TIFFTAG_PHOTOMETRIC, &page.photometric);
  TIFFGetFieldDefaulted(tiff, TIFFTAG_COMPRESSION, &page.compression);
  return page;
}

}  // namespace fvd
