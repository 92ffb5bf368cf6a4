#pragma once

/// Drawing words, lines and pictures on a page. Only sources of this folder include it: it includes cairo and pango.

#include <memory>
#include <span>
#include <string>

#include <cairo.h>
#include <pango/pangocairo.h>

#include "daemon/report/colour.hpp"
#include "daemon/report/raster.hpp"

namespace fvd {

/// In points (1/72 inch), x right, y down.
struct PagePoint {
  double x = 0.0;
  double y = 0.0;
};
struct PageRect {
  double x = 0.0;
  double y = 0.0;
  double width = 0.0;
  double height = 0.0;
  [[nodiscard]] double right() const { return x + width; }
  [[nodiscard]] double bottom() const { return y + height; }
};

enum class TextAlign { kLeft, kCentre, kRight };

struct TextStyle {
  double size = 8.0;  ///< in points
  Colour ink = colour::kInk;
  bool bold = false;
  TextAlign align = TextAlign::kLeft;
  double room = 0.0;  ///< in points; longer text is cut and ends with an ellipsis; 0 = there is room enough
};

/// Text is UTF-8 in DejaVu Sans; what is not UTF-8 is shown as replacement characters. context: one thread.
class Canvas {
 public:
  /// cairo: outlives the canvas. Throws Error kInternal where there is no font.
  explicit Canvas(cairo_t* cairo);

  /// One line; at: on its base line, at the end or middle that style.align tells.
  void text(PagePoint at, const std::string& words, const TextStyle& style);
  /// The same, turned by 90 degrees against the clock.
  void text_upwards(PagePoint at, const std::string& words, const TextStyle& style);
  [[nodiscard]] double text_width(const std::string& words, const TextStyle& style);

  /// Lines of at most `width`, broken at words; the first `lead` letters' bytes are bold. Returns the height they take.
  double paragraph(PagePoint top_left, double width, const std::string& words, const TextStyle& style,
                   std::size_t lead = 0);
  [[nodiscard]] double paragraph_height(double width, const std::string& words, const TextStyle& style,
                                        std::size_t lead = 0);

  void line(PagePoint from, PagePoint to, const Colour& ink, double width = 0.5);
  void polyline(std::span<const PagePoint> points, const Colour& ink, double width = 0.8);
  void polygon(std::span<const PagePoint> points, const Colour& ink);
  void polygon_outline(std::span<const PagePoint> points, const Colour& ink, double width = 0.8);
  void disc(PagePoint centre, double radius, const Colour& ink);
  void fill(const PageRect& place, const Colour& ink, double opacity = 1.0);
  void frame(const PageRect& place, const Colour& ink, double width = 0.5);
  /// Lines at 45 degrees, `distance` apart, inside the place.
  void hatch(const PageRect& place, const Colour& ink, double distance = 4.0);
  /// Stretched to the place; smooth: interpolated where it is enlarged.
  void picture(const PageRect& place, const Raster& raster, bool smooth);

  /// Until end_clip() nothing is drawn outside.
  void begin_clip(const PageRect& place);
  void end_clip();

 private:
  struct Unref {
    void operator()(gpointer object) const noexcept { g_object_unref(object); }
  };
  using Layout = std::unique_ptr<PangoLayout, Unref>;
  [[nodiscard]] Layout layout_of(const std::string& words, const TextStyle& style, double width, std::size_t lead);
  void set_ink(const Colour& ink);
  void path(std::span<const PagePoint> points);

  cairo_t* cairo_;
  std::unique_ptr<PangoContext, Unref> context_;
};

}  // namespace fvd
