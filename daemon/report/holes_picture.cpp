/// Why points are holes, as a picture.

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "daemon/report/axis_ticks.hpp"
#include "daemon/report/hole_reasons.hpp"
#include "daemon/report/map_plot.hpp"
#include "daemon/report/page_file.hpp"
#include "daemon/report/picture_page.hpp"
#include "daemon/report/surface_pictures.hpp"

namespace fvd {

namespace {

constexpr double kLegendWidth = 230.0;
constexpr double kLegendRow = 14.0;
constexpr std::uint32_t kValidColour = 0x00EDEDED;
constexpr std::uint32_t kUnknownColour = 0x00AAAAAA;

std::uint32_t colour_of(MaskReasons reasons) {
  for (const HoleReason& reason : hole_reasons()) {
    if ((reasons & reason.bit) != 0) return reason.colour;
  }
  return kUnknownColour;
}

Colour as_colour(std::uint32_t rgb) {
  const auto part = [rgb](unsigned shift) { return static_cast<double>(rgb >> shift & 0xFFU) / 255.0; };
  return {part(16), part(8), part(0)};
}

/// 0 = valid. Without a mask nothing but the hole is known.
MaskReasons reasons_at(const PictureSurface& surface, int x, int y) {
  constexpr MaskReasons kUnknown = 1U << 15U;
  if (surface.mask.data != nullptr && surface.mask.at(x, y) != 0) return surface.mask.at(x, y);
  return std::isnan(surface.height_m.at(x, y)) ? kUnknown : MaskReasons{0};
}

/// A block that has a hole shows one: single holes are not lost where the field is shrunk.
Raster reasons_raster(const PictureSurface& surface) {
  const int width = surface.height_m.width;
  const int height = surface.height_m.height;
  const int factor = shrink_factor(width, height, kMostPicturePixels);
  Raster raster((width + factor - 1) / factor, (height + factor - 1) / factor, kValidColour);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      if (const MaskReasons reasons = reasons_at(surface, x, y); reasons != 0) {
        raster.at(x / factor, y / factor) = colour_of(reasons);
      }
    }
  }
  return raster;
}

struct LegendRow {
  std::string name;
  std::uint32_t colour = 0;
  std::size_t points = 0;
};

std::vector<LegendRow> legend_of(const PictureSurface& surface) {
  std::vector<LegendRow> rows{{"valid", kValidColour, 0}};
  for (const HoleReason& reason : hole_reasons()) rows.push_back({reason.name, reason.colour, 0});
  rows.push_back({"reason not known", kUnknownColour, 0});
  MaskReasons known = 0;
  for (const HoleReason& reason : hole_reasons()) known = static_cast<MaskReasons>(known | reason.bit);
  for (int y = 0; y < surface.height_m.height; ++y) {
    for (int x = 0; x < surface.height_m.width; ++x) {
      const MaskReasons reasons = reasons_at(surface, x, y);
      if (reasons == 0) {
        ++rows.front().points;
        continue;
      }
      if ((reasons & known) == 0) ++rows.back().points;
      std::size_t row = 1;
      for (const HoleReason& reason : hole_reasons()) rows[row++].points += (reasons & reason.bit) != 0 ? 1 : 0;
    }
  }
  const auto is_absent = [](const LegendRow& row) { return row.points == 0; };
  rows.erase(std::remove_if(rows.begin() + 1, rows.end(), is_absent), rows.end());
  return rows;
}

void draw_legend(Canvas& canvas, const PicturePage& page, const std::vector<LegendRow>& rows, std::size_t points) {
  const double x = page.field.right() + 12.0;
  double y = page.field.y;
  for (const LegendRow& row : rows) {
    const PageRect sample{x, y, 9.0, 9.0};
    canvas.fill(sample, as_colour(row.colour));
    canvas.frame(sample, colour::kPaleInk);
    const double percent = 100.0 * static_cast<double>(row.points) / static_cast<double>(points);
    canvas.text({x + 14.0, y + 7.5}, row.name, {.size = 7.0, .room = 136.0});
    canvas.text({x + kLegendWidth - 18.0, y + 7.5}, std::to_string(row.points) + ", " + fixed_text(percent, 2) + " %",
                {.size = 7.0, .ink = colour::kPaleInk, .align = TextAlign::kRight});
    y += kLegendRow;
  }
}

}  // namespace

std::string holes_png(const PictureSurface& surface) {
  const std::vector<LegendRow> rows = legend_of(surface);
  const auto points =
      static_cast<std::size_t>(surface.height_m.width) * static_cast<std::size_t>(surface.height_m.height);
  const PicturePage page = picture_page(surface, kLegendWidth, kLegendRow * static_cast<double>(rows.size()));
  PictureFile file(page.width, page.height);
  draw_page_title(file.canvas(), page, surface, "why points are holes; one with several reasons has the upper colour");
  draw_map(file.canvas(), page.field, surface, reasons_raster(surface), Shown::kClasses);
  draw_legend(file.canvas(), page, rows, points);
  return file.bytes();
}

}  // namespace fvd
