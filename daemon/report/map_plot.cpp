#include "daemon/report/map_plot.hpp"

#include <algorithm>
#include <cmath>

#include "daemon/report/axis_ticks.hpp"

namespace fvd {

namespace {

constexpr double kLabel = 6.5;
constexpr double kTick = 3.0;

int tick_count(double points) { return std::clamp(static_cast<int>(points / 38.0), 3, 11); }

void draw_columns(Canvas& canvas, const PageRect& field, const PictureSurface& surface) {
  const AxisTicks ticks = axis_ticks(0.0, surface.width_um(), tick_count(field.width));
  for (const double value : ticks.values) {
    const double x = field.x + value / surface.width_um() * field.width;
    canvas.line({x, field.bottom()}, {x, field.bottom() + kTick}, colour::kInk);
    canvas.text({x, field.bottom() + kTick + 7.0}, fixed_text(value, ticks.decimals),
                {.size = kLabel, .align = TextAlign::kCentre});
  }
  canvas.text({field.x + field.width / 2.0, field.bottom() + 20.0}, std::string("x / ") + surface.lateral_unit(),
              {.size = kLabel, .align = TextAlign::kCentre});
}

void draw_rows(Canvas& canvas, const PageRect& field, const PictureSurface& surface) {
  const AxisTicks ticks = axis_ticks(0.0, surface.height_um(), tick_count(field.height));
  for (const double value : ticks.values) {
    const double y = field.y + value / surface.height_um() * field.height;
    canvas.line({field.x - kTick, y}, {field.x, y}, colour::kInk);
    canvas.text({field.x - kTick - 2.0, y + 2.3}, fixed_text(value, ticks.decimals),
                {.size = kLabel, .align = TextAlign::kRight});
  }
  canvas.text_upwards({field.x - 26.0, field.y + field.height / 2.0}, std::string("y / ") + surface.lateral_unit(),
                      {.size = kLabel, .align = TextAlign::kCentre});
}

}  // namespace

PageRect field_place(const PictureSurface& surface, const PageRect& place) {
  const double width = place.width - kMapLeft - kBarRoom;
  const double height = place.height - kMapBottom;
  const double points_per_um = std::min(width / surface.width_um(), height / surface.height_um());
  // A field that is very long and narrow stays visible.
  constexpr double kLeast = 8.0;
  return {place.x + kMapLeft, place.y, std::max(kLeast, surface.width_um() * points_per_um),
          std::max(kLeast, surface.height_um() * points_per_um)};
}

void draw_map(Canvas& canvas, const PageRect& field, const PictureSurface& surface, const Raster& raster, Shown shown) {
  // Points larger than this are seen as squares, which they are.
  constexpr double kSeen = 2.0;
  canvas.picture(field, raster, shown == Shown::kValues && field.width / raster.width < kSeen);
  canvas.frame(field, colour::kPaleInk);
  draw_columns(canvas, field, surface);
  draw_rows(canvas, field, surface);
}

void draw_colour_bar(Canvas& canvas, const PageRect& field, const ValueRange& range, ColourScale scale,
                     const std::string& title) {
  const PageRect bar{field.right() + 8.0, field.y, 9.0, std::max(field.height, 60.0)};
  if (!range.any) {
    canvas.text({bar.x, bar.y + 8.0}, "no valid point", {.size = kLabel});
    return;
  }
  const auto& colours = colours_of(scale);
  Raster ramp(1, static_cast<int>(colours.size()), 0);
  std::reverse_copy(colours.begin(), colours.end(), ramp.pixels.begin());
  canvas.picture(bar, ramp, true);
  canvas.frame(bar, colour::kPaleInk);
  const AxisTicks ticks = axis_ticks(range.low, range.high, std::clamp(static_cast<int>(bar.height / 20.0), 3, 11));
  for (const double value : ticks.values) {
    const double y = bar.bottom() - (value - range.low) / (range.high - range.low) * bar.height;
    canvas.line({bar.right(), y}, {bar.right() + kTick, y}, colour::kInk);
    canvas.text({bar.right() + kTick + 2.0, y + 2.3}, fixed_text(value, ticks.decimals), {.size = kLabel});
  }
  canvas.text_upwards({bar.right() + 40.0, bar.y + bar.height / 2.0}, title,
                      {.size = kLabel, .align = TextAlign::kCentre});
}

}  // namespace fvd
