#include "daemon/report/picture_page.hpp"

#include <algorithm>
#include <cmath>

#include "daemon/report/axis_ticks.hpp"
#include "daemon/report/map_plot.hpp"

namespace fvd {

namespace {

constexpr double kMargin = 12.0;
constexpr double kTitleHeight = 40.0;
constexpr double kKeyHeight = 20.0;
constexpr double kLongerSide = 520.0;
constexpr double kLeastSide = 40.0;
constexpr double kLeastWidth = 300.0;

}  // namespace

PicturePage picture_page(const PictureSurface& surface, double beside, double least) {
  const double longer_um = std::max(surface.width_um(), surface.height_um());
  const auto side = [&](double um) { return std::max(kLeastSide, kLongerSide * um / longer_um); };
  PicturePage page;
  page.field = {kMargin + kMapLeft, kMargin + kTitleHeight, side(surface.width_um()), side(surface.height_um())};
  page.width = static_cast<int>(std::ceil(std::max(page.field.right() + beside + kMargin, kLeastWidth)));
  const double below = std::max(page.field.bottom() + kMapBottom + kKeyHeight, page.field.y + least);
  page.height = static_cast<int>(std::ceil(below + kMargin));
  return page;
}

void draw_page_title(Canvas& canvas, const PicturePage& page, const PictureSurface& surface, const std::string& what) {
  double right = page.width - kMargin;
  if (surface.simulated) {
    const TextStyle badge{.size = 9.0, .ink = colour::kBad, .bold = true, .align = TextAlign::kRight};
    canvas.text({right, kMargin + 11.0}, "SIMULATED", badge);
    right -= canvas.text_width("SIMULATED", badge) + kMargin;
  }
  canvas.text({kMargin, kMargin + 11.0}, surface.title, {.size = 11.0, .bold = true, .room = right - kMargin});
  canvas.text({kMargin, kMargin + 26.0}, what,
              {.size = 8.0, .ink = colour::kPaleInk, .room = page.width - 2.0 * kMargin});
}

void draw_hole_key(Canvas& canvas, const PicturePage& page) {
  const PageRect sample{page.field.x, page.field.bottom() + kMapBottom + 4.0, 8.0, 8.0};
  canvas.fill(sample, colour::kHole);
  canvas.frame(sample, colour::kPaleInk);
  canvas.text({sample.right() + 4.0, sample.bottom() - 1.5}, "no valid height", {.size = 6.5});
}

void draw_scale_bar(Canvas& canvas, const PicturePage& page, const PictureSurface& surface, double x) {
  if (!surface.is_metric()) return;
  const double points_per_um = page.field.width / surface.width_um();
  const double length_um = round_step(surface.width_um() / 4.0);
  const int decimals = std::max(0, -static_cast<int>(std::floor(std::log10(length_um) + 1e-9)));
  const double y = page.field.bottom() + kMapBottom + 6.0;
  canvas.fill({x, y, length_um * points_per_um, 3.0}, colour::kInk);
  canvas.text({x + length_um * points_per_um + 5.0, y + 4.0}, fixed_text(length_um, decimals) + " µm", {.size = 7.0});
}

}  // namespace fvd
