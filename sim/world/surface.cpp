#include "sim/world/surface.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include <opencv2/imgproc.hpp>

#include "core/base/error.hpp"
#include "sim/artefact/stepped_artefacts.hpp"
#include "sim/world/artefact_surface.hpp"
#include "sim/world/contrast_map.hpp"
#include "sim/world/gsf_reader.hpp"
#include "sim/world/layered_renderer.hpp"

namespace fvd::sim {

namespace {

struct Rectangle {
  int x = 0;
  int y = 0;
  int width = 0;
  int height = 0;
};

void fill(Plane<std::uint8_t>& plane, const Rectangle& r, std::uint8_t value) {
  for (int y = r.y; y < r.y + r.height; ++y) std::fill_n(plane.row(y) + r.x, r.width, value);
}

Rectangle grown(const Rectangle& r, int by) { return {r.x - by, r.y - by, r.width + 2 * by, r.height + 2 * by}; }

Surface blank(int width, int height) {
  return {Plane<float>(width, height), Plane<float>(width, height, 1.0F), Plane<std::uint8_t>(width, height),
          Plane<std::uint8_t>(width, height)};
}

/// The whole image but its margin is one region.
void mark_surface(Surface& surface) {
  const int width = surface.height_um.width() - 2 * kRegionMargin_px;
  const int height = surface.height_um.height() - 2 * kRegionMargin_px;
  if (width <= 0 || height <= 0) return;
  fill(surface.region, {kRegionMargin_px, kRegionMargin_px, width, height},
       static_cast<std::uint8_t>(Region::kSurface));
}

/// Plateaus of 0, 50 and 100 um, each a quarter of the width, then a ramp from 100 to 160 um; 60 x 110 pixels of the
/// middle plateau have hardly any texture.
Surface chapter(const WorldParameters& world) {
  constexpr int kWidth = 480;
  constexpr int kHeight = 360;
  constexpr int kStrip = 120;
  constexpr double kRise_um = 60.0;
  if (world.width_px != kWidth || world.height_px != kHeight) {
    throw Error(ErrorCode::kBadConfig, "the chapter's surface is 480 x 360 pixels, not " +
                                           std::to_string(world.width_px) + " x " + std::to_string(world.height_px));
  }
  Surface surface = blank(kWidth, kHeight);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const int strip = x / kStrip;
      const double ramp = 100.0 + kRise_um * (x - 3 * kStrip) / (kStrip - 1);
      surface.height_um.at(x, y) = static_cast<float>(x < 3 * kStrip ? 50.0 * strip : ramp);
    }
  }
  const Rectangle poor{150, 125, 60, 110};
  for (int strip = 0; strip < 4; ++strip) {
    const Rectangle whole{strip * kStrip, 0, kStrip, kHeight};
    fill(surface.region, grown(whole, -kRegionMargin_px), static_cast<std::uint8_t>(strip + 1));
  }
  fill(surface.region, grown(poor, kRegionMargin_px), static_cast<std::uint8_t>(Region::kNone));
  fill(surface.region, poor, static_cast<std::uint8_t>(Region::kPoor));
  fill(surface.poor, poor, 1);
  for (int y = poor.y; y < poor.y + poor.height; ++y) {
    std::fill_n(surface.contrast.row(y) + poor.x, poor.width, static_cast<float>(world.poor_contrast));
  }
  return surface;
}

Surface tilted(const WorldParameters& world) {
  Surface surface = blank(world.width_px, world.height_px);
  for (int y = 0; y < world.height_px; ++y) {
    for (int x = 0; x < world.width_px; ++x) {
      surface.height_um.at(x, y) =
          static_cast<float>(world.base_um + world.tilt_x_um_per_px * (x - 0.5 * (world.width_px - 1)) +
                             world.tilt_y_um_per_px * (y - 0.5 * (world.height_px - 1)));
    }
  }
  return surface;
}

/// A ball in a plane, which may be tilted: the ball's centre lies on the plane's normal in the middle of the image.
Surface sphere(const WorldParameters& world) {
  Surface surface = blank(world.width_px, world.height_px);
  const Tilt& tilt = world.artefacts.tilt;
  const double up = (world.cap_height_um - world.radius_um) / std::hypot(tilt.slope_x, tilt.slope_y, 1.0);
  const PixelGrid grid = grid_of(world);
  for (int y = 0; y < world.height_px; ++y) {
    for (int x = 0; x < world.width_px; ++x) {
      const Place place = grid.centre(x, y);
      const double dx = place.x_um + up * tilt.slope_x;
      const double dy = place.y_um + up * tilt.slope_y;
      const double square = world.radius_um * world.radius_um - dx * dx - dy * dy;
      const double plane = world.base_um + plane_um(tilt, place);
      const double height = square > 0 ? world.base_um + up + std::sqrt(square) : plane;
      surface.height_um.at(x, y) = static_cast<float>(std::max(height, plane));
    }
  }
  return surface;
}

Surface rough(const WorldParameters& world) {
  Surface surface = blank(world.width_px, world.height_px);
  cv::Mat heights(world.height_px, world.width_px, CV_32F, surface.height_um.row(0));
  std::mt19937_64 random(world.seed + 77);
  std::normal_distribution<float> normal;
  for (float& height : surface.height_um.pixels()) height = normal(random);
  cv::GaussianBlur(heights, heights, {}, world.correlation_px, world.correlation_px, cv::BORDER_REFLECT);
  cv::Scalar mean;
  cv::Scalar sd;
  cv::meanStdDev(heights, mean, sd);
  heights = (heights - mean[0]) * (world.sq_um / sd[0]) + world.base_um;
  return surface;
}

/// The near plane where it covers whole pixels. Each side but its margin is a region; poor where it has no texture.
Surface layered(const WorldParameters& world) {
  Surface surface = blank(world.width_px, world.height_px);
  const auto is_near = [&](int x, int y) { return near_coverage(world, x, y) >= 1.0; };
  const auto inside = [&](int x, int y) {  // no edge within the margin, which is short against a radius
    for (int v = -kRegionMargin_px; v <= kRegionMargin_px; v += kRegionMargin_px) {
      for (int u = -kRegionMargin_px; u <= kRegionMargin_px; u += kRegionMargin_px) {
        if (is_near(x + u, y + v) != is_near(x, y)) return false;
      }
    }
    return true;
  };
  mark_surface(surface);
  for (int y = 0; y < world.height_px; ++y) {
    for (int x = 0; x < world.width_px; ++x) {
      const bool near = is_near(x, y);
      surface.height_um.at(x, y) = static_cast<float>(world.base_um + (near ? world.layer_gap_um : 0.0));
      const bool poor = (near ? world.near : world.far).contrast == 0.0;
      surface.poor.at(x, y) = poor ? 1 : 0;
      std::uint8_t& region = surface.region.at(x, y);
      if (region == static_cast<std::uint8_t>(Region::kNone)) continue;
      region = static_cast<std::uint8_t>(!inside(x, y) ? Region::kNone : poor ? Region::kPoor : Region::kSurface);
    }
  }
  return surface;
}

Surface from_file(const WorldParameters& world) {
  Plane<float> height_um = read_gsf_um(world.height_map_file);
  Surface surface = blank(height_um.width(), height_um.height());
  surface.height_um = std::move(height_um);
  return surface;
}

void add_plane(const WorldParameters& world, Surface& surface) {
  const PixelGrid grid{surface.height_um.width(), surface.height_um.height(), world.pixel_pitch_um};
  for (int y = 0; y < grid.height_px; ++y) {
    for (int x = 0; x < grid.width_px; ++x) {
      surface.height_um.at(x, y) += static_cast<float>(plane_um(world.artefacts.tilt, grid.centre(x, y)));
    }
  }
}

/// Takes out of the regions what lies within the margin of another label.
void leave_borders_of(Plane<std::uint8_t>& labels, Plane<std::uint8_t>& region) {
  const cv::Mat of(labels.height(), labels.width(), CV_8U, labels.row(0));
  const cv::Mat window = cv::Mat::ones(2 * kRegionMargin_px + 1, 2 * kRegionMargin_px + 1, CV_8U);
  cv::Mat least;
  cv::Mat most;
  cv::erode(of, least, window);
  cv::dilate(of, most, window);
  for (int y = 0; y < region.height(); ++y) {
    for (int x = 0; x < region.width(); ++x) {
      const bool alone = least.at<std::uint8_t>(y, x) == most.at<std::uint8_t>(y, x);
      if (!alone || labels.at(x, y) == kWall) region.at(x, y) = static_cast<std::uint8_t>(Region::kNone);
    }
  }
}

/// The contrast map, and what of the surface counts as poor in texture.
void polish(const WorldParameters& world, Surface& surface) {
  surface.contrast = make_contrast(world, surface.height_um.width(), surface.height_um.height());
  std::ranges::transform(surface.contrast.pixels(), surface.poor.pixels().begin(),
                         [](float share) { return static_cast<std::uint8_t>(share < kPoorShare ? 1 : 0); });
  leave_borders_of(surface.poor, surface.region);
  for (std::size_t i = 0; i < surface.poor.pixels().size(); ++i) {
    if (surface.poor.pixels()[i] != 0) surface.region.pixels()[i] = static_cast<std::uint8_t>(Region::kPoor);
  }
}

}  // namespace

Surface make_surface(const WorldParameters& world) {
  if (world.surface == SurfaceKind::kChapter) return chapter(world);
  if (world.surface == SurfaceKind::kLayered) return layered(world);
  Surface surface;
  Plane<std::uint8_t> level;
  switch (world.surface) {
    case SurfaceKind::kTilted:
      surface = tilted(world);
      break;
    case SurfaceKind::kSphere:
      surface = sphere(world);
      break;
    case SurfaceKind::kRough:
      surface = rough(world);
      add_plane(world, surface);
      break;
    case SurfaceKind::kHeightMap:
      surface = from_file(world);
      add_plane(world, surface);
      break;
    default:
      surface = blank(world.width_px, world.height_px);
      ArtefactSurface artefact = make_artefact(world);
      surface.height_um = std::move(artefact.height_um);
      level = std::move(artefact.level);
  }
  mark_surface(surface);
  if (!level.empty()) leave_borders_of(level, surface.region);
  polish(world, surface);
  return surface;
}

}  // namespace fvd::sim
