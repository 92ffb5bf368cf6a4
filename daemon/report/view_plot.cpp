#include "daemon/report/view_plot.hpp"

#include <algorithm>
#include <cmath>
#include <locale>
#include <sstream>
#include <string>

#include "daemon/report/axis_ticks.hpp"
#include "daemon/report/shaded_view.hpp"

namespace fvd {

namespace {

constexpr double kPixelsPerPoint = 2.5;
constexpr double kLabel = 6.5;
constexpr double kRoom = 16.0;  ///< for words at the sides
constexpr double kCaption = 12.0;

std::string short_text(double value) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text << value;
  return text.str();
}

std::string three_digits(double value) {
  const int decimals = value > 0.0 ? std::max(0, 2 - static_cast<int>(std::floor(std::log10(value)))) : 0;
  return fixed_text(value, std::min(decimals, 4));
}

std::string caption(const ShadedView& view) {
  if (!view.range.any) return "no valid point";
  const double exaggeration = view.frame.exaggeration;
  return "heights shown " + three_digits(view.range.high - view.range.low) + " µm, " +
         (exaggeration == 1.0 ? "to scale" : short_text(exaggeration) + " times exaggerated");
}

}  // namespace

void draw_view(Canvas& canvas, const PageRect& place, const PictureSurface& surface) {
  const PageRect inside{place.x + kRoom, place.y, place.width - 2.0 * kRoom, place.height - kCaption - 6.0};
  const ShadedView view = shaded_view(surface, static_cast<int>(inside.width * kPixelsPerPoint),
                                      static_cast<int>(inside.height * kPixelsPerPoint));
  canvas.picture(inside, view.raster, true);
  const auto at = [&](double x_um, double y_um, double z_um) {
    const ViewFrame::Place pixel = view.frame.at(x_um, y_um, z_um);
    return PagePoint{inside.x + pixel.x / kPixelsPerPoint, inside.y + pixel.y / kPixelsPerPoint};
  };
  const double low = view.frame.low_um;
  const double width = surface.width_um();
  const double height = surface.height_um();
  // The other two sides may be hidden.
  const PagePoint base[] = {at(0.0, 0.0, low), at(0.0, height, low), at(width, height, low)};
  canvas.polyline(base, colour::kPaleInk, 0.4);
  const std::string unit = std::string(" ") + surface.lateral_unit();
  const auto middle = [](PagePoint a, PagePoint b) { return PagePoint{(a.x + b.x) / 2.0, (a.y + b.y) / 2.0}; };
  const PagePoint left = middle(base[0], base[1]);
  canvas.text({left.x - 3.0, left.y + 9.0}, "y " + short_text(height) + unit,
              {.size = kLabel, .align = TextAlign::kRight});
  const PagePoint front = middle(base[1], base[2]);
  canvas.text({front.x + 4.0, front.y + 9.0}, "x " + short_text(width) + unit, {.size = kLabel});
  if (view.range.any) {
    const PagePoint top = at(0.0, 0.0, view.range.high);
    canvas.line(base[0], top, colour::kPaleInk, 0.4);
  }
  canvas.text({place.x + place.width / 2.0, place.bottom() - 2.0}, caption(view),
              {.size = kLabel, .align = TextAlign::kCentre});
}

}  // namespace fvd
