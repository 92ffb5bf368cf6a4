#include "daemon/report/shaded_view.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <vector>

#include "daemon/report/axis_ticks.hpp"
#include "daemon/report/colour_scale.hpp"

namespace fvd {

namespace {

constexpr double kAzimuth = 28.0 * std::numbers::pi / 180.0;
constexpr double kElevation = 38.0 * std::numbers::pi / 180.0;
constexpr double kHeightShare = 0.3;  ///< of the longer side, which exaggerated heights do not exceed
constexpr double kRangeFraction = 0.005;
constexpr int kMostCells = 420;
constexpr double kMargin_px = 4.0;
constexpr double kAmbient = 0.45;
constexpr std::uint32_t kPaper = 0x00FFFFFF;
constexpr std::uint32_t kWall = 0x00D8D8D8;
constexpr double kFrontLight = 1.0;
constexpr double kLeftLight = 0.88;

/// Towards the light: left, front, above; of length 1.
constexpr std::array<double, 3> kLight{-0.48, -0.36, 0.80};

double exaggeration_of(double longer_um, double span_um) {
  return std::max(1.0, round_step(kHeightShare * longer_um / span_um));
}

/// Scale and offset so that the box of the surface fills the picture.
void fit(ViewFrame& frame, const PictureSurface& surface, double high_um, int width, int height) {
  double left = std::numeric_limits<double>::infinity();
  double top = left;
  double right = -left;
  double bottom = -left;
  for (const double x : {0.0, surface.width_um()}) {
    for (const double y : {0.0, surface.height_um()}) {
      for (const double z : {frame.low_um, high_um}) {
        const ViewFrame::Place place = frame.at(x, y, z);
        left = std::min(left, place.x);
        right = std::max(right, place.x);
        top = std::min(top, place.y);
        bottom = std::max(bottom, place.y);
      }
    }
  }
  frame.scale = std::min((width - 2.0 * kMargin_px) / (right - left), (height - 2.0 * kMargin_px) / (bottom - top));
  frame.offset_x = width / 2.0 - frame.scale * (left + right) / 2.0;
  frame.offset_y = height / 2.0 - frame.scale * (top + bottom) / 2.0;
}

std::uint32_t lit(std::uint32_t rgb, double light) {
  const auto part = [&](unsigned shift) {
    const double level = static_cast<double>(rgb >> shift & 0xFFU) * light;
    return static_cast<std::uint32_t>(std::clamp(std::lround(level), 0L, 255L)) << shift;
  };
  return part(16U) | part(8U) | part(0U);
}

/// A corner on the raster, with its place on the scale of colours.
struct Vertex {
  ViewFrame::Place place;
  double share = 0.0;  ///< 0..1
};

/// Triangles onto the raster, the nearest in front.
class Painter {
 public:
  explicit Painter(Raster& raster)
      : raster_(raster), depth_(raster.pixels.size(), -std::numeric_limits<double>::infinity()) {}

  /// colours: between the corners by their shares. light: of the whole triangle.
  void triangle(const Vertex& a, const Vertex& b, const Vertex& c, std::span<const std::uint32_t> colours,
                double light) {
    const ViewFrame::Place& p = a.place;
    const ViewFrame::Place& q = b.place;
    const ViewFrame::Place& r = c.place;
    const double area = (q.x - p.x) * (r.y - p.y) - (r.x - p.x) * (q.y - p.y);
    if (area == 0.0) return;
    const int left = std::max(0, static_cast<int>(std::floor(std::min({p.x, q.x, r.x}))));
    const int right = std::min(raster_.width - 1, static_cast<int>(std::ceil(std::max({p.x, q.x, r.x}))));
    const int top = std::max(0, static_cast<int>(std::floor(std::min({p.y, q.y, r.y}))));
    const int bottom = std::min(raster_.height - 1, static_cast<int>(std::ceil(std::max({p.y, q.y, r.y}))));
    for (int y = top; y <= bottom; ++y) {
      for (int x = left; x <= right; ++x) {
        const double px = x + 0.5;
        const double py = y + 0.5;
        const double v = ((px - p.x) * (r.y - p.y) - (r.x - p.x) * (py - p.y)) / area;
        const double w = ((q.x - p.x) * (py - p.y) - (px - p.x) * (q.y - p.y)) / area;
        constexpr double kSeam = -1e-9;  // neighbours leave no gap between them
        if (v < kSeam || w < kSeam || v + w > 1.0 - kSeam) continue;
        double& nearest =
            depth_[static_cast<std::size_t>(y) * static_cast<std::size_t>(raster_.width) + static_cast<std::size_t>(x)];
        const double depth = p.depth + v * (q.depth - p.depth) + w * (r.depth - p.depth);
        if (depth <= nearest) continue;
        nearest = depth;
        const double share = a.share + v * (b.share - a.share) + w * (c.share - a.share);
        const double level = std::clamp(share, 0.0, 1.0) * static_cast<double>(colours.size() - 1);
        raster_.at(x, y) = lit(colours[static_cast<std::size_t>(std::lround(level))], light);
      }
    }
  }

 private:
  Raster& raster_;
  std::vector<double> depth_;
};

class Mesh {
 public:
  Mesh(const PictureSurface& surface, const ScalarImage& image, const ShadedView& view)
      : image_(image), view_(view), colours_(colours_of(ColourScale::kViridis)) {
    const int factor = shrink_factor(surface.height_m.width, surface.height_m.height, kMostCells);
    step_x_um_ = factor * surface.pitch_x();
    step_y_um_ = factor * surface.pitch_y();
    width_um_ = surface.width_um();
    height_um_ = surface.height_um();
  }

  void draw(Raster& raster) const {
    Painter painter(raster);
    for (int y = 0; y + 1 < image_.height; ++y) {
      for (int x = 0; x + 1 < image_.width; ++x) {
        const Corner a = corner(x, y);
        const Corner b = corner(x + 1, y);
        const Corner c = corner(x, y + 1);
        const Corner d = corner(x + 1, y + 1);
        // The diagonal that both triangles of a cell share; a cell with one hole has the triangle that is left.
        if (std::isnan(b.z) || std::isnan(c.z)) {
          one(painter, a, std::isnan(b.z) ? c : d, std::isnan(b.z) ? d : b);
        } else {
          one(painter, a, c, b);
          one(painter, b, c, d);
        }
      }
    }
    for (int x = 0; x + 1 < image_.width; ++x) {
      wall(painter, corner(x, image_.height - 1), corner(x + 1, image_.height - 1), kFrontLight);
    }
    for (int y = 0; y + 1 < image_.height; ++y) wall(painter, corner(0, y), corner(0, y + 1), kLeftLight);
  }

 private:
  struct Corner {
    double x = 0.0;  ///< um
    double y = 0.0;
    double z = 0.0;  ///< NaN = hole
  };

  /// Middles of blocks, those at the border moved to it.
  [[nodiscard]] Corner corner(int x, int y) const {
    const auto along = [](int i, int count, double step_um, double length_um) {
      if (i == 0) return 0.0;
      return i == count - 1 ? length_um : (i + 0.5) * step_um;
    };
    const auto z = static_cast<double>(image_.at(x, y));
    return {along(x, image_.width, step_x_um_, width_um_), along(y, image_.height, step_y_um_, height_um_),
            std::isnan(z) ? z : std::clamp(z, view_.range.low, view_.range.high)};
  }

  /// Corners counter-clockwise as seen from above with y downwards.
  void one(Painter& painter, const Corner& a, const Corner& b, const Corner& c) const {
    if (std::isnan(a.z) || std::isnan(b.z) || std::isnan(c.z)) return;
    const double e = view_.frame.exaggeration;
    const std::array<double, 3> u{b.x - a.x, -(b.y - a.y), e * (b.z - a.z)};
    const std::array<double, 3> v{c.x - a.x, -(c.y - a.y), e * (c.z - a.z)};
    const std::array<double, 3> normal{u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
    const double length = std::hypot(normal[0], normal[1], normal[2]);
    if (!(length > 0.0)) return;
    const double cosine = (normal[0] * kLight[0] + normal[1] * kLight[1] + normal[2] * kLight[2]) / length;
    const double light = kAmbient + (1.0 - kAmbient) * std::max(0.0, cosine) / kLight[2];
    painter.triangle(vertex(a), vertex(b), vertex(c), colours_, light);
  }

  /// From the border down to the base: what is cut there is seen as solid.
  void wall(Painter& painter, const Corner& a, const Corner& b, double light) const {
    if (std::isnan(a.z) || std::isnan(b.z)) return;
    const Vertex low_a = vertex({a.x, a.y, view_.frame.low_um});
    const Vertex low_b = vertex({b.x, b.y, view_.frame.low_um});
    constexpr std::array kGrey{kWall};
    painter.triangle(vertex(a), low_a, vertex(b), kGrey, light);
    painter.triangle(vertex(b), low_a, low_b, kGrey, light);
  }

  [[nodiscard]] Vertex vertex(const Corner& corner) const {
    return {view_.frame.at(corner.x, corner.y, corner.z),
            (corner.z - view_.range.low) / (view_.range.high - view_.range.low)};
  }

  const ScalarImage& image_;
  const ShadedView& view_;
  const std::array<std::uint32_t, 256>& colours_;
  double step_x_um_ = 1.0;
  double step_y_um_ = 1.0;
  double width_um_ = 1.0;
  double height_um_ = 1.0;
};

}  // namespace

ViewFrame::Place ViewFrame::at(double x_um, double y_um, double z_um) const {
  // y upwards in the image is away from the observer.
  const double right = std::cos(kAzimuth) * x_um + std::sin(kAzimuth) * y_um;
  const double away = std::sin(kAzimuth) * x_um - std::cos(kAzimuth) * y_um;
  const double up = exaggeration * (z_um - low_um);
  return {offset_x + scale * right, offset_y - scale * (std::sin(kElevation) * away + std::cos(kElevation) * up),
          std::sin(kElevation) * up - std::cos(kElevation) * away};
}

ShadedView shaded_view(const PictureSurface& surface, int width, int height) {
  ShadedView view;
  const ScalarImage image = shrunk_um(surface.height_m, kMostCells);
  view.range = robust_range(image, kRangeFraction);
  view.frame.low_um = view.range.low;
  if (view.range.any) {
    view.frame.exaggeration =
        exaggeration_of(std::max(surface.width_um(), surface.height_um()), view.range.high - view.range.low);
  }
  fit(view.frame, surface, view.range.high, width, height);
  view.raster = Raster(width, height, kPaper);
  Mesh(surface, image, view).draw(view.raster);
  return view;
}

}  // namespace fvd
