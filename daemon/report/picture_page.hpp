#pragma once

/// The page that pictures of the whole field share. Only sources of this folder include it.

#include <string>

#include "daemon/report/canvas.hpp"
#include "daemon/report/picture_surface.hpp"

namespace fvd {

/// A side of a field in a picture has no more points of the surface than these.
inline constexpr int kMostPicturePixels = 1200;

struct PicturePage {
  int width = 0;  ///< in points
  int height = 0;
  PageRect field;
};

/// beside: room at the field's right; least: height that what stands there needs; both in points.
[[nodiscard]] PicturePage picture_page(const PictureSurface& surface, double beside, double least = 0.0);

/// The surface's title, what the picture shows, and SIMULATED where it is.
void draw_page_title(Canvas& canvas, const PicturePage& page, const PictureSurface& surface, const std::string& what);

/// What grey means, below the field.
void draw_hole_key(Canvas& canvas, const PicturePage& page);

/// Below the field from x on, where the pitch is known.
void draw_scale_bar(Canvas& canvas, const PicturePage& page, const PictureSurface& surface, double x);

}  // namespace fvd
