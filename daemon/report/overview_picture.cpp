/// The map of a result for people, with what was measured.

#include <algorithm>
#include <cmath>
#include <vector>

#include "daemon/report/axis_ticks.hpp"
#include "daemon/report/map_plot.hpp"
#include "daemon/report/page_file.hpp"
#include "daemon/report/picture_page.hpp"
#include "daemon/report/scalar_image.hpp"
#include "daemon/report/surface_pictures.hpp"
#include "daemon/report/time_text.hpp"
#include "daemon/report/value_rows.hpp"
#include "daemon/report/value_table.hpp"
#include "daemon/report/verdict_sign.hpp"

namespace fvd {

namespace {

constexpr double kMargin = 12.0;
constexpr double kSecondLine = 11.0;  ///< below what other pictures have above their field
constexpr double kGap = 8.0;
constexpr double kColourFraction = 0.005;  ///< of the heights, beyond the ends of the colours at either side
constexpr int kLeastWidth = 500;           ///< of the table
constexpr std::size_t kMostRows = 12;

std::string conditions_text(const Result& result) {
  const double percent = 100.0 * result.valid_fraction();
  std::string valid = fixed_text(percent, 1);
  if (valid == "100.0" && result.valid_points < result.points) valid = "99.9";  // 100 % means all
  return (result.recipe.id.empty() ? "" : "recipe " + result.recipe.id + ", ") + std::to_string(result.steps.steps) +
         " slices, window " + std::to_string(result.focus.settings.window_px) + " px, " +
         std::string(peak_method_name(result.focus.peak)) + ", " + valid + " % valid";
}

std::string origin_text(const Result& result) {
  const std::string time = people_time_text(result.provenance.created);
  return result.job.id.empty() ? time : "job " + result.job.id + ", " + time;
}

/// Of each measurement the main value and those that have limits; the map's where nothing was evaluated.
std::vector<ValueRow> main_rows(const Result& result) {
  std::vector<ValueRow> rows = value_rows(result);
  if (!result.evaluation) return rows;
  std::erase_if(rows, [](const ValueRow& row) { return row.measurement.empty() && row.limits.empty(); });
  return rows;
}

void draw_verdict(Canvas& canvas, const PicturePage& page, Verdict verdict) {
  const TextStyle style{.size = 9.0, .ink = verdict_ink(verdict), .bold = true, .align = TextAlign::kRight};
  const double right = page.width - kMargin;
  canvas.text({right, kMargin + 26.0}, verdict_word(verdict), style);
  draw_verdict_sign(canvas, {right - canvas.text_width(verdict_word(verdict), style) - 9.0, kMargin + 23.0}, 9.0,
                    verdict);
}

}  // namespace

std::string overview_png(const PictureSurface& surface, const Result& result) {
  const std::vector<ValueRow> all = main_rows(result);
  const std::vector<ValueRow> rows(all.begin(),
                                   all.begin() + static_cast<std::ptrdiff_t>(std::min(all.size(), kMostRows)));
  const bool more = rows.size() < all.size();
  PicturePage page = picture_page(surface, kBarRoom);
  page.width = std::max(page.width, kLeastWidth);
  page.field.y += kSecondLine;
  const double table_top = page.height + kSecondLine - kMargin + kGap;
  const double table_end = table_top + (rows.empty() ? -kGap : table_height(rows.size())) + (more ? 12.0 : 0.0);
  page.height = static_cast<int>(std::ceil(table_end + kMargin));
  PictureFile file(page.width, page.height);
  Canvas& canvas = file.canvas();
  draw_page_title(canvas, page, surface, origin_text(result));
  canvas.text({kMargin, kMargin + 26.0 + kSecondLine}, conditions_text(result),
              {.size = 8.0, .ink = colour::kPaleInk, .room = page.width - 2.0 * kMargin});
  if (result.verdict) draw_verdict(canvas, page, *result.verdict);
  const ScalarImage image = shrunk_um(surface.height_m, kMostPicturePixels);
  const ValueRange range = robust_range(image, kColourFraction);
  draw_map(canvas, page.field, surface, coloured(image, range, ColourScale::kViridis));
  draw_colour_bar(canvas, page.field, range, ColourScale::kViridis, "height / µm");
  draw_hole_key(canvas, page);
  draw_scale_bar(canvas, page, surface, page.field.x + 90.0);
  const double width = page.width - 2.0 * kMargin;
  if (!rows.empty()) draw_table(canvas, {kMargin, table_top}, width, rows);
  if (more) {
    canvas.text({kMargin, table_end - 2.0}, "and " + std::to_string(all.size() - rows.size()) + " more in result.json",
                {.size = 7.0, .ink = colour::kPaleInk});
  }
  return file.bytes();
}

}  // namespace fvd
