#include "daemon/report/study_page.hpp"

#include <algorithm>
#include <cmath>

#include "daemon/report/axis_ticks.hpp"
#include "daemon/report/colour_scale.hpp"
#include "daemon/report/map_plot.hpp"
#include "daemon/report/page_file.hpp"
#include "daemon/report/picture_surface.hpp"
#include "daemon/report/scalar_image.hpp"

namespace fvd {

namespace {

constexpr double kMargin = 36.0;
constexpr double kGap = 8.0;
constexpr double kRow = 11.5;
constexpr double kText = 7.5;
constexpr double kSmall = 6.5;
constexpr double kLabelRoom = 58.0;
constexpr double kPictureHeight = 230.0;
constexpr double kFoot = 16.0;
constexpr std::size_t kMostRows = 28;
constexpr int kMostMapPixels = 700;
constexpr double kColourFraction = 0.005;

const PageRect kPage{kMargin, kMargin - 6.0, PdfFile::kWidth - 2.0 * kMargin, PdfFile::kHeight - 2.0 * kMargin + 12.0};

double draw_head(Canvas& canvas, const StudyPage& page) {
  double room = kPage.width;
  if (page.simulated) {
    canvas.text({kPage.right(), kPage.y + 14.5}, "SIMULATED",
                {.size = 10.0, .ink = colour::kBad, .bold = true, .align = TextAlign::kRight});
    room -= 80.0;
  }
  canvas.text({kPage.x, kPage.y + 15.0}, page.title, {.size = 15.0, .bold = true, .room = room});
  canvas.text({kPage.x, kPage.y + 26.0}, page.subtitle, {.size = kText, .ink = colour::kPaleInk, .room = kPage.width});
  double y = kPage.y + 40.0;
  const double half = kPage.width / 2.0;
  for (std::size_t i = 0; i < page.facts.size(); ++i) {
    const double x = kPage.x + (i % 2 == 0 ? 0.0 : half + 6.0);
    canvas.text({x, y}, page.facts[i].first, {.size = kSmall, .ink = colour::kPaleInk});
    canvas.text({x + kLabelRoom, y}, page.facts[i].second.empty() ? "-" : page.facts[i].second,
                {.size = kText, .room = half - kLabelRoom - 10.0});
    if (i % 2 == 1 || i + 1 == page.facts.size()) y += 11.0;
  }
  canvas.line({kPage.x, y - 4.0}, {kPage.right(), y - 4.0}, colour::kInk, 0.6);
  return y + 6.0;
}

/// The longest is as long as arrows may be without a tangle.
void draw_arrows(Canvas& canvas, const PageRect& field, const StudyMap& map) {
  constexpr double kLongest = 16.0;
  double longest_um = 0.0;
  for (const StudyArrow& arrow : map.arrows) longest_um = std::max(longest_um, std::hypot(arrow.x_um, arrow.y_um));
  const double per_um = longest_um > 0.0 ? kLongest / longest_um : 0.0;
  const double per_column = field.width / map.height_m.width();
  const double per_row = field.height / map.height_m.height();
  for (const StudyArrow& arrow : map.arrows) {
    const PagePoint tail{field.x + (arrow.column + 0.5) * per_column, field.y + (arrow.row + 0.5) * per_row};
    const PagePoint head{tail.x + arrow.x_um * per_um, tail.y + arrow.y_um * per_um};
    canvas.disc(tail, 1.1, colour::kBad);
    canvas.line(tail, head, colour::kBad, 0.8);
  }
  canvas.text({field.x, field.bottom() + kMapBottom}, map.arrows_title,
              {.size = kSmall, .ink = colour::kBad, .room = field.width + kBarRoom});
}

void draw_map(Canvas& canvas, const PageRect& place, const StudyMap& map) {
  PictureSurface surface;
  surface.height_m = map.height_m.view();
  surface.pitch_x_um = map.pitch_x_um;
  surface.pitch_y_um = map.pitch_y_um;
  const PageRect field = field_place(surface, place);
  const ScalarImage image = shrunk_um(surface.height_m, kMostMapPixels);
  const ValueRange range = robust_range(image, kColourFraction);
  const ColourScale scale = map.errors ? ColourScale::kMagma : ColourScale::kViridis;
  draw_map(canvas, field, surface, coloured(image, range, scale));
  draw_colour_bar(canvas, field, range, scale, map.title);
  if (!map.arrows.empty()) draw_arrows(canvas, field, map);
}

/// The ends of an axis that has all the values with some room, and its ticks.
struct Axis {
  double low = 0.0;
  double high = 1.0;

  void take(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  void widen() {
    const double span = high > low ? high - low : 1.0;
    low -= 0.08 * span;
    high += 0.08 * span;
  }
};

void draw_points(Canvas& canvas, const PageRect& place, const StudyPlot& plot) {
  constexpr double kLeft = 40.0;
  const PageRect inside{place.x + kLeft, place.y + 12.0, place.width - kLeft - 6.0, place.height - 38.0};
  canvas.text({inside.x, place.y + 7.0}, plot.title, {.size = kSmall, .bold = true, .room = inside.width});
  Axis across{plot.points.front().x, plot.points.front().x};
  Axis up{0.0, 0.0};
  for (const StudyPlotPoint& point : plot.points) {
    across.take(point.x);
    up.take(point.y - 2.0 * point.u.value_or(0.0));
    up.take(point.y + 2.0 * point.u.value_or(0.0));
  }
  across.widen();
  up.widen();
  const auto x_of = [&](double x) { return inside.x + (x - across.low) / (across.high - across.low) * inside.width; };
  const auto y_of = [&](double y) { return inside.bottom() - (y - up.low) / (up.high - up.low) * inside.height; };
  const TextStyle label{.size = 6.0, .align = TextAlign::kCentre};
  const AxisTicks columns = axis_ticks(across.low, across.high, 7);
  for (const double value : columns.values) {
    canvas.line({x_of(value), inside.bottom()}, {x_of(value), inside.bottom() + 2.5}, colour::kInk);
    canvas.text({x_of(value), inside.bottom() + 9.0}, fixed_text(value, columns.decimals), label);
  }
  const AxisTicks rows = axis_ticks(up.low, up.high, 7);
  for (const double value : rows.values) {
    canvas.line({inside.x, y_of(value)}, {inside.right(), y_of(value)}, colour::kGrid, 0.3);
    canvas.text({inside.x - 3.0, y_of(value) + 2.0}, fixed_text(value, rows.decimals),
                {.size = 6.0, .align = TextAlign::kRight});
  }
  canvas.line({inside.x, y_of(0.0)}, {inside.right(), y_of(0.0)}, colour::kPaleInk, 0.6);
  for (const StudyPlotPoint& point : plot.points) {
    const double x = x_of(point.x);
    if (point.u) canvas.line({x, y_of(point.y - 2.0 * *point.u)}, {x, y_of(point.y + 2.0 * *point.u)}, colour::kLine);
    canvas.disc({x, y_of(point.y)}, 1.8, colour::kLine);
  }
  canvas.text({inside.x + inside.width / 2.0, inside.bottom() + 18.0}, plot.x_title, label);
  canvas.text_upwards({inside.x - 32.0, inside.y + inside.height / 2.0}, plot.y_title, label);
  canvas.frame(inside, colour::kPaleInk);
}

double draw_pictures(Canvas& canvas, double top, const StudyPage& page) {
  const bool has_plot = page.plot && !page.plot->points.empty();
  if (!page.map && !has_plot) return top;
  const double width = page.map && has_plot ? (kPage.width - kGap) / 2.0 : kPage.width;
  if (page.map) draw_map(canvas, {kPage.x, top, width, kPictureHeight}, *page.map);
  if (has_plot) draw_points(canvas, {kPage.right() - width, top, width, kPictureHeight}, *page.plot);
  return top + kPictureHeight + kGap;
}

void draw_row(Canvas& canvas, double base, const StudyRow& row) {
  const auto x = [](double share) { return kPage.x + share * kPage.width; };
  canvas.text({x(0.0), base}, row.name, {.size = kText, .room = 0.38 * kPage.width});
  canvas.text({x(0.54), base}, row.value, {.size = kText, .bold = true, .align = TextAlign::kRight});
  if (row.reason.empty()) {
    canvas.text({x(0.74), base}, row.uncertainty, {.size = kText, .align = TextAlign::kRight});
    canvas.text({x(0.77), base}, row.unit, {.size = kText});
  } else {
    canvas.text({x(0.56), base}, row.reason, {.size = kSmall, .ink = colour::kPaleInk, .room = 0.44 * kPage.width});
  }
}

double draw_rows(Canvas& canvas, double top, const StudyPage& page) {
  const TextStyle head{.size = kSmall, .ink = colour::kPaleInk, .align = TextAlign::kRight};
  const double base = top + kRow - 3.5;
  canvas.text({kPage.x, base}, "Quantity", {.size = kSmall, .ink = colour::kPaleInk});
  canvas.text({kPage.x + 0.54 * kPage.width, base}, "Value", head);
  canvas.text({kPage.x + 0.74 * kPage.width, base}, "U (k)", head);
  canvas.text({kPage.x + 0.77 * kPage.width, base}, "Unit", {.size = kSmall, .ink = colour::kPaleInk});
  double y = top + kRow;
  canvas.line({kPage.x, y}, {kPage.right(), y}, colour::kInk, 0.6);
  y += 1.5;
  for (std::size_t i = 0; i < std::min(page.rows.size(), kMostRows); ++i) {
    draw_row(canvas, y + kRow - 3.3, page.rows[i]);
    y += kRow;
    canvas.line({kPage.x, y}, {kPage.right(), y}, colour::kGrid, 0.4);
  }
  if (page.rows.size() <= kMostRows) return y + kGap;
  canvas.text({kPage.x, y + 9.0}, std::to_string(page.rows.size() - kMostRows) + " more are in study.json",
              {.size = kSmall, .ink = colour::kPaleInk});
  return y + kRow + kGap;
}

void draw_notes(Canvas& canvas, double top, const StudyPage& page) {
  const TextStyle style{.size = kSmall};
  const double bottom = kPage.bottom() - kFoot - 10.0;
  double y = top;
  for (std::size_t i = 0; i < page.notes.size(); ++i) {
    const std::string words = page.notes[i].first + ":  " + page.notes[i].second;
    const std::size_t lead = page.notes[i].first.size() + 1;
    const double height = canvas.paragraph_height(kPage.width, words, style, lead);
    if (y + height > bottom) {
      canvas.text({kPage.x, bottom + 6.0}, std::to_string(page.notes.size() - i) + " more notes are in study.json",
                  {.size = kSmall, .ink = colour::kPaleInk});
      return;
    }
    canvas.paragraph({kPage.x, y}, kPage.width, words, style, lead);
    y += height + 1.5;
  }
}

void draw_foot(Canvas& canvas, const StudyPage& page) {
  const double y = kPage.bottom();
  canvas.line({kPage.x, y - 9.0}, {kPage.right(), y - 9.0}, colour::kRule, 0.4);
  canvas.text({kPage.x, y}, "fvd " + page.software_version + "   " + page.foot,
              {.size = 6.0, .ink = colour::kPaleInk, .room = kPage.width});
}

}  // namespace

std::string study_pdf(const StudyPage& page) {
  PdfFile file({page.title, "fvd " + page.software_version, page.created});
  Canvas& canvas = file.canvas();
  double y = draw_head(canvas, page);
  y = draw_pictures(canvas, y, page);
  y = draw_rows(canvas, y, page);
  draw_notes(canvas, y, page);
  draw_foot(canvas, page);
  return file.bytes();
}

}  // namespace fvd
