#include "daemon/report/page_file.hpp"

#include <string>
#include <utility>

#include "core/base/error.hpp"
#include "daemon/report/time_text.hpp"

namespace fvd {

namespace {

cairo_status_t append(void* bytes, const unsigned char* data, unsigned int size) {
  static_cast<std::string*>(bytes)->append(reinterpret_cast<const char*>(data), size);
  return CAIRO_STATUS_SUCCESS;
}

void check(cairo_status_t status) {
  if (status == CAIRO_STATUS_SUCCESS) return;
  throw Error(ErrorCode::kInternal, std::string("cairo could not draw a page: ") + cairo_status_to_string(status));
}

/// Of any bytes; cairo refuses what is not UTF-8.
std::string valid_utf8(const std::string& text) {
  char* const made = g_utf8_make_valid(text.data(), static_cast<gssize>(text.size()));
  std::string valid(made);
  g_free(made);
  return valid;
}

cairo_surface_t* white_image(int width, int height) {
  constexpr int kScale = PictureFile::kPixelsPerPoint;
  cairo_surface_t* const surface = cairo_image_surface_create(CAIRO_FORMAT_RGB24, kScale * width, kScale * height);
  cairo_surface_set_device_scale(surface, kScale, kScale);
  return surface;
}

}  // namespace

PdfFile::PdfFile(const PdfFacts& facts)
    : surface_(cairo_pdf_surface_create_for_stream(append, &bytes_, kWidth, kHeight)),
      cairo_(cairo_create(surface_.get())),
      canvas_(cairo_.get()) {
  check(cairo_surface_status(surface_.get()));
  cairo_pdf_surface_restrict_to_version(surface_.get(), CAIRO_PDF_VERSION_1_5);
  const auto tell = [this](cairo_pdf_metadata_t what, const std::string& text) {
    cairo_pdf_surface_set_metadata(surface_.get(), what, valid_utf8(text).c_str());
  };
  tell(CAIRO_PDF_METADATA_TITLE, facts.title);
  tell(CAIRO_PDF_METADATA_CREATOR, facts.creator);
  tell(CAIRO_PDF_METADATA_CREATE_DATE, iso_time_text(facts.created));  // cairo would take today's
}

void PdfFile::next_page() { cairo_show_page(cairo_.get()); }

std::string PdfFile::bytes() {
  cairo_show_page(cairo_.get());
  cairo_surface_finish(surface_.get());
  check(cairo_status(cairo_.get()));
  check(cairo_surface_status(surface_.get()));
  return std::move(bytes_);
}

PictureFile::PictureFile(int width, int height)
    : surface_(white_image(width, height)), cairo_(cairo_create(surface_.get())), canvas_(cairo_.get()) {
  check(cairo_surface_status(surface_.get()));
  cairo_set_source_rgb(cairo_.get(), 1.0, 1.0, 1.0);
  cairo_paint(cairo_.get());
}

std::string PictureFile::bytes() {
  check(cairo_status(cairo_.get()));
  std::string bytes;
  check(cairo_surface_write_to_png_stream(surface_.get(), append, &bytes));
  return bytes;
}

}  // namespace fvd
