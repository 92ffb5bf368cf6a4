#pragma once

/// Pages as the bytes of a PDF or PNG file. Only sources of this folder include it: it includes cairo.

#include <chrono>
#include <memory>
#include <string>

#include <cairo-pdf.h>
#include <cairo.h>

#include "daemon/report/canvas.hpp"

namespace fvd {

/// What a PDF file tells of itself.
struct PdfFacts {
  std::string title;
  std::string creator;
  std::chrono::system_clock::time_point created;
};

struct CairoDestroy {
  void operator()(cairo_surface_t* surface) const noexcept { cairo_surface_destroy(surface); }
  void operator()(cairo_t* cairo) const noexcept { cairo_destroy(cairo); }
};

/// Pages of A4, text as text. The same drawing gives the same bytes: nothing in it is of the time or the machine.
/// Throws Error kInternal where cairo fails. context: one thread.
class PdfFile {
 public:
  static constexpr double kWidth = 595.28;  ///< of a page, in points
  static constexpr double kHeight = 841.89;

  explicit PdfFile(const PdfFacts& facts);
  [[nodiscard]] Canvas& canvas() { return canvas_; }
  void next_page();
  /// Ends the last page. Call once, last.
  [[nodiscard]] std::string bytes();

 private:
  std::string bytes_;
  std::unique_ptr<cairo_surface_t, CairoDestroy> surface_;
  std::unique_ptr<cairo_t, CairoDestroy> cairo_;
  Canvas canvas_;
};

/// A picture of white paper, two pixels a point. Throws as above.
class PictureFile {
 public:
  static constexpr int kPixelsPerPoint = 2;

  /// In points.
  PictureFile(int width, int height);
  [[nodiscard]] Canvas& canvas() { return canvas_; }
  /// A PNG.
  [[nodiscard]] std::string bytes();

 private:
  std::unique_ptr<cairo_surface_t, CairoDestroy> surface_;
  std::unique_ptr<cairo_t, CairoDestroy> cairo_;
  Canvas canvas_;
};

}  // namespace fvd
