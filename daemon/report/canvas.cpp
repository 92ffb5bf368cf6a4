#include "daemon/report/canvas.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "core/base/error.hpp"

namespace fvd {

namespace {

constexpr const char* kFont = "DejaVu Sans";

struct GFree {
  void operator()(char* text) const noexcept { g_free(text); }
};

/// UTF-8 without line breaks and control characters.
std::string shown(const std::string& words) {
  const std::unique_ptr<char, GFree> valid(g_utf8_make_valid(words.data(), static_cast<gssize>(words.size())));
  std::string text(valid.get());
  std::replace_if(
      text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < ' '; }, ' ');
  return text;
}

void set_bold(PangoLayout* layout, std::size_t bytes) {
  const std::string range = "0 " + std::to_string(bytes) + " weight bold";
  PangoAttrList* const list = pango_attr_list_from_string(range.c_str());
  pango_layout_set_attributes(layout, list);
  pango_attr_list_unref(list);
}

struct ObjectUnref {
  void operator()(gpointer object) const noexcept { g_object_unref(object); }
};

/// Kept from one picture to the next: a map of its own finds each font anew, in threads of Pango's.
PangoFontMap* fonts_of_thread() {
  thread_local const std::unique_ptr<PangoFontMap, ObjectUnref> fonts(
      pango_cairo_font_map_new_for_font_type(CAIRO_FONT_TYPE_FT));
  if (!fonts) throw Error(ErrorCode::kInternal, "pango has no fonts of FreeType");
  return fonts.get();
}

double in_points(int pango_units) { return static_cast<double>(pango_units) / PANGO_SCALE; }

}  // namespace

Canvas::Canvas(cairo_t* cairo) : cairo_(cairo), context_(pango_font_map_create_context(fonts_of_thread())) {
  // Not fitted to a screen's pixels: a line is as long in a PDF as in a picture.
  cairo_font_options_t* options = cairo_font_options_create();
  cairo_font_options_set_hint_style(options, CAIRO_HINT_STYLE_NONE);
  cairo_font_options_set_hint_metrics(options, CAIRO_HINT_METRICS_OFF);
  cairo_font_options_set_antialias(options, CAIRO_ANTIALIAS_GRAY);
  pango_cairo_context_set_font_options(context_.get(), options);
  cairo_font_options_destroy(options);
  pango_context_set_round_glyph_positions(context_.get(), FALSE);
  pango_cairo_context_set_resolution(context_.get(), 72.0);
}

Canvas::Layout Canvas::layout_of(const std::string& words, const TextStyle& style, double width, std::size_t lead) {
  Layout layout(pango_layout_new(context_.get()));
  PangoFontDescription* font = pango_font_description_from_string(kFont);
  pango_font_description_set_absolute_size(font, style.size * PANGO_SCALE);
  if (style.bold) pango_font_description_set_weight(font, PANGO_WEIGHT_BOLD);
  pango_layout_set_font_description(layout.get(), font);
  pango_font_description_free(font);
  const std::string text = shown(words);
  pango_layout_set_text(layout.get(), text.data(), static_cast<int>(text.size()));
  if (lead > 0) set_bold(layout.get(), lead);
  if (width > 0.0) {
    pango_layout_set_width(layout.get(), static_cast<int>(width * PANGO_SCALE));
    pango_layout_set_wrap(layout.get(), PANGO_WRAP_WORD_CHAR);
  } else {
    pango_layout_set_single_paragraph_mode(layout.get(), TRUE);
    if (style.room > 0.0) {
      pango_layout_set_width(layout.get(), static_cast<int>(style.room * PANGO_SCALE));
      pango_layout_set_ellipsize(layout.get(), PANGO_ELLIPSIZE_END);
    }
  }
  return layout;
}

void Canvas::set_ink(const Colour& ink) { cairo_set_source_rgb(cairo_, ink.red, ink.green, ink.blue); }

void Canvas::text(PagePoint at, const std::string& words, const TextStyle& style) {
  const Layout layout = layout_of(words, style, 0.0, 0);
  PangoRectangle logical;
  pango_layout_get_extents(layout.get(), nullptr, &logical);
  const double width = in_points(logical.width);
  const double shift = style.align == TextAlign::kLeft ? 0.0 : style.align == TextAlign::kRight ? width : width / 2.0;
  set_ink(style.ink);
  cairo_move_to(cairo_, at.x - shift - in_points(logical.x), at.y - in_points(pango_layout_get_baseline(layout.get())));
  pango_cairo_show_layout(cairo_, layout.get());
}

void Canvas::text_upwards(PagePoint at, const std::string& words, const TextStyle& style) {
  cairo_save(cairo_);
  cairo_translate(cairo_, at.x, at.y);
  cairo_rotate(cairo_, -std::numbers::pi / 2.0);
  text({0.0, 0.0}, words, style);
  cairo_restore(cairo_);
}

double Canvas::text_width(const std::string& words, const TextStyle& style) {
  PangoRectangle logical;
  pango_layout_get_extents(layout_of(words, style, 0.0, 0).get(), nullptr, &logical);
  return in_points(logical.width);
}

double Canvas::paragraph(PagePoint top_left, double width, const std::string& words, const TextStyle& style,
                         std::size_t lead) {
  const Layout layout = layout_of(words, style, width, lead);
  set_ink(style.ink);
  cairo_move_to(cairo_, top_left.x, top_left.y);
  pango_cairo_show_layout(cairo_, layout.get());
  PangoRectangle logical;
  pango_layout_get_extents(layout.get(), nullptr, &logical);
  return in_points(logical.height);
}

double Canvas::paragraph_height(double width, const std::string& words, const TextStyle& style, std::size_t lead) {
  PangoRectangle logical;
  pango_layout_get_extents(layout_of(words, style, width, lead).get(), nullptr, &logical);
  return in_points(logical.height);
}

void Canvas::line(PagePoint from, PagePoint to, const Colour& ink, double width) {
  const PagePoint ends[] = {from, to};
  polyline(ends, ink, width);
}

void Canvas::path(std::span<const PagePoint> points) {
  cairo_new_path(cairo_);
  for (const PagePoint& point : points) cairo_line_to(cairo_, point.x, point.y);
}

void Canvas::polyline(std::span<const PagePoint> points, const Colour& ink, double width) {
  path(points);
  set_ink(ink);
  cairo_set_line_width(cairo_, width);
  cairo_set_line_join(cairo_, CAIRO_LINE_JOIN_ROUND);
  cairo_stroke(cairo_);
}

void Canvas::polygon(std::span<const PagePoint> points, const Colour& ink) {
  path(points);
  cairo_close_path(cairo_);
  set_ink(ink);
  cairo_fill(cairo_);
}

void Canvas::polygon_outline(std::span<const PagePoint> points, const Colour& ink, double width) {
  path(points);
  cairo_close_path(cairo_);
  set_ink(ink);
  cairo_set_line_width(cairo_, width);
  cairo_stroke(cairo_);
}

void Canvas::disc(PagePoint centre, double radius, const Colour& ink) {
  cairo_new_path(cairo_);
  cairo_arc(cairo_, centre.x, centre.y, radius, 0.0, 2.0 * std::numbers::pi);
  set_ink(ink);
  cairo_fill(cairo_);
}

void Canvas::fill(const PageRect& place, const Colour& ink, double opacity) {
  cairo_rectangle(cairo_, place.x, place.y, place.width, place.height);
  cairo_set_source_rgba(cairo_, ink.red, ink.green, ink.blue, opacity);
  cairo_fill(cairo_);
}

void Canvas::frame(const PageRect& place, const Colour& ink, double width) {
  cairo_rectangle(cairo_, place.x, place.y, place.width, place.height);
  set_ink(ink);
  cairo_set_line_width(cairo_, width);
  cairo_stroke(cairo_);
}

void Canvas::hatch(const PageRect& place, const Colour& ink, double distance) {
  begin_clip(place);
  cairo_new_path(cairo_);
  // Of the whole page, so that the lines of neighbouring places meet.
  const double first = std::floor((place.x + place.y) / distance) * distance;
  for (double sum = first; sum <= place.right() + place.bottom(); sum += distance) {
    cairo_move_to(cairo_, sum - place.bottom(), place.bottom());
    cairo_line_to(cairo_, sum - place.y, place.y);
  }
  set_ink(ink);
  cairo_set_line_width(cairo_, 0.4);
  cairo_stroke(cairo_);
  end_clip();
}

void Canvas::picture(const PageRect& place, const Raster& raster, bool smooth) {
  assert(raster.width > 0 && raster.height > 0);
  cairo_surface_t* image = cairo_image_surface_create(CAIRO_FORMAT_RGB24, raster.width, raster.height);
  if (cairo_surface_status(image) != CAIRO_STATUS_SUCCESS) {
    cairo_surface_destroy(image);
    throw Error(ErrorCode::kInternal, "a picture is too large to be drawn");
  }
  unsigned char* rows = cairo_image_surface_get_data(image);
  const int stride_bytes = cairo_image_surface_get_stride(image);
  for (int y = 0; y < raster.height; ++y) {
    const auto first = raster.pixels.begin() + static_cast<std::ptrdiff_t>(y) * raster.width;
    std::copy_n(first, raster.width,
                reinterpret_cast<std::uint32_t*>(rows + static_cast<std::ptrdiff_t>(y) * stride_bytes));
  }
  cairo_surface_mark_dirty(image);
  cairo_save(cairo_);
  cairo_rectangle(cairo_, place.x, place.y, place.width, place.height);
  cairo_clip(cairo_);
  cairo_translate(cairo_, place.x, place.y);
  cairo_scale(cairo_, place.width / raster.width, place.height / raster.height);
  cairo_set_source_surface(cairo_, image, 0.0, 0.0);
  cairo_pattern_set_filter(cairo_get_source(cairo_), smooth ? CAIRO_FILTER_GOOD : CAIRO_FILTER_NEAREST);
  cairo_pattern_set_extend(cairo_get_source(cairo_), CAIRO_EXTEND_PAD);
  cairo_paint(cairo_);
  cairo_restore(cairo_);
  cairo_surface_destroy(image);
}

void Canvas::begin_clip(const PageRect& place) {
  cairo_save(cairo_);
  cairo_rectangle(cairo_, place.x, place.y, place.width, place.height);
  cairo_clip(cairo_);
}

void Canvas::end_clip() { cairo_restore(cairo_); }

}  // namespace fvd
