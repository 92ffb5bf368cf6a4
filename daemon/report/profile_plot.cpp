#include "daemon/report/profile_plot.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "daemon/report/axis_ticks.hpp"
#include "daemon/report/section_points.hpp"

namespace fvd {

namespace {

constexpr double kLabel = 6.0;
constexpr double kLeft = 26.0;
constexpr double kTop = 11.0;
constexpr double kBottom = 20.0;

/// Where the plot is on the page.
struct Plot {
  PageRect inside;
  double length_um = 1.0;
  double low_um = 0.0;
  double high_um = 1.0;
  [[nodiscard]] double x(double along_um) const { return inside.x + along_um / length_um * inside.width; }
  [[nodiscard]] double y(double z_um) const {
    return inside.bottom() - (z_um - low_um) / (high_um - low_um) * inside.height;
  }
};

/// The heights with some room above and below.
void fit_heights(const std::vector<SectionPoint>& points, const CrossSection& section, Plot& plot) {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const SectionPoint& point : points) {
    if (std::isnan(point.height_um)) continue;
    low = std::min(low, point.height_um);
    high = std::max(high, point.height_um);
  }
  if (low > high) return;
  for (const CrossSection::Curve& curve : section.fit) {
    for (const double z_um : curve.z_um) {
      low = std::min(low, z_um);
      high = std::max(high, z_um);
    }
  }
  constexpr double kLeastSpan_um = 0.01;
  const double span = std::max(high - low, kLeastSpan_um);
  const double middle = (low + high) / 2.0;
  plot.low_um = middle - 0.58 * span;
  plot.high_um = middle + 0.66 * span;  // the regions' names are above the line
}

void draw_axes(Canvas& canvas, const Plot& plot, const PictureSurface& surface) {
  const PageRect& inside = plot.inside;
  const AxisTicks along = axis_ticks(0.0, plot.length_um, std::clamp(static_cast<int>(inside.width / 36.0), 3, 11));
  for (const double value : along.values) {
    const double x = plot.x(value);
    canvas.line({x, inside.bottom()}, {x, inside.bottom() + 2.5}, colour::kInk);
    canvas.text({x, inside.bottom() + 9.0}, fixed_text(value, along.decimals),
                {.size = kLabel, .align = TextAlign::kCentre});
  }
  canvas.text({inside.x + inside.width / 2.0, inside.bottom() + 17.0},
              std::string("along the section / ") + surface.lateral_unit(),
              {.size = kLabel, .align = TextAlign::kCentre});
  const AxisTicks up = axis_ticks(plot.low_um, plot.high_um, std::clamp(static_cast<int>(inside.height / 16.0), 3, 9));
  for (const double value : up.values) {
    const double y = plot.y(value);
    canvas.line({inside.x, y}, {inside.right(), y}, colour::kGrid, 0.3);
    canvas.text({inside.x - 3.0, y + 2.0}, fixed_text(value, up.decimals),
                {.size = kLabel, .align = TextAlign::kRight});
  }
  canvas.text_upwards({inside.x - 21.0, inside.y + inside.height / 2.0}, "measured z / µm",
                      {.size = kLabel, .align = TextAlign::kCentre});
}

void draw_regions(Canvas& canvas, const Plot& plot, const CrossSection& section) {
  for (const CrossSection::Region& region : section.regions) {
    const double left = plot.x(std::clamp(region.from_um, 0.0, plot.length_um));
    const double right = plot.x(std::clamp(region.to_um, 0.0, plot.length_um));
    if (right <= left) continue;
    const PageRect strip{left, plot.inside.y, right - left, plot.inside.height};
    canvas.fill(strip, colour::kRegion, 0.14);
    canvas.hatch(strip, colour::kRegion);
    canvas.text({(left + right) / 2.0, plot.inside.y + 8.0}, region.name,
                {.size = kLabel + 0.5, .ink = colour::kLine, .bold = true, .align = TextAlign::kCentre});
  }
}

/// The line, broken at holes, which are hatched.
void draw_line(Canvas& canvas, const Plot& plot, const std::vector<SectionPoint>& points) {
  const double half_um = plot.length_um / static_cast<double>(points.size()) / 2.0;
  std::vector<PagePoint> line;
  const auto finish = [&] {
    if (line.size() == 1) canvas.disc(line.front(), 0.5, colour::kLine);
    if (line.size() > 1) canvas.polyline(line, colour::kLine);
    line.clear();
  };
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!std::isnan(points[i].height_um)) {
      line.push_back({plot.x(points[i].along_um), plot.y(points[i].height_um)});
      continue;
    }
    finish();
    const std::size_t first = i;
    while (i + 1 < points.size() && std::isnan(points[i + 1].height_um)) ++i;
    const double left = plot.x(points[first].along_um - half_um);
    const PageRect gap{left, plot.inside.y, plot.x(points[i].along_um + half_um) - left, plot.inside.height};
    canvas.fill(gap, colour::kHole, 0.25);
    canvas.hatch(gap, colour::kHole, 2.5);
  }
  finish();
}

void draw_fit(Canvas& canvas, const Plot& plot, const CrossSection& section) {
  canvas.begin_clip(plot.inside);
  for (const CrossSection::Curve& curve : section.fit) {
    std::vector<PagePoint> line;
    for (std::size_t i = 0; i < std::min(curve.along_um.size(), curve.z_um.size()); ++i) {
      line.push_back({plot.x(curve.along_um[i]), plot.y(curve.z_um[i])});
    }
    if (line.size() > 1) canvas.polyline(line, colour::kFit, 1.0);
  }
  canvas.end_clip();
}

/// At the right above the plot; returns the room that it takes.
double draw_fit_key(Canvas& canvas, const Plot& plot, const CrossSection& section, double base) {
  if (section.fit.empty() || section.fit_name.empty()) return 0.0;
  const TextStyle style{.size = kLabel, .align = TextAlign::kRight};
  constexpr double kSample = 14.0;
  const double width = canvas.text_width(section.fit_name, style);
  canvas.text({plot.inside.right(), base}, section.fit_name, style);
  const double left = plot.inside.right() - width - kSample - 4.0;
  canvas.line({left, base - 2.0}, {left + kSample, base - 2.0}, colour::kFit, 1.0);
  return width + kSample + 10.0;
}

}  // namespace

void draw_profile(Canvas& canvas, const PageRect& place, const PictureSurface& surface, const CrossSection& section,
                  const std::string& title) {
  const std::vector<SectionPoint> points = section_points(surface, section);
  Plot plot;
  plot.inside = {place.x + kLeft, place.y + kTop, place.width - kLeft - 4.0, place.height - kTop - kBottom};
  plot.length_um = section.length_um();
  fit_heights(points, section, plot);
  const double key = draw_fit_key(canvas, plot, section, place.y + 7.0);
  canvas.text({place.x + kLeft, place.y + 7.0}, title, {.size = 6.5, .bold = true, .room = place.width - kLeft - key});
  draw_axes(canvas, plot, surface);
  draw_regions(canvas, plot, section);
  draw_line(canvas, plot, points);
  draw_fit(canvas, plot, section);
  canvas.frame(plot.inside, colour::kPaleInk);
}

}  // namespace fvd
