#pragma once

/// A picture of the whole field with axes, and a bar that tells its colours. Only sources of this folder include it.

#include <string>

#include "daemon/report/canvas.hpp"
#include "daemon/report/colour_scale.hpp"
#include "daemon/report/picture_surface.hpp"

namespace fvd {

/// Room beside the field, in points.
inline constexpr double kMapLeft = 34.0;    ///< for the rows' axis
inline constexpr double kMapBottom = 26.0;  ///< for the columns' axis
inline constexpr double kBarRoom = 62.0;    ///< for the colour bar

/// The largest rectangle of the field's proportions, as wide as it is in um, in the place without its axes; at the
/// place's top left.
[[nodiscard]] PageRect field_place(const PictureSurface& surface, const PageRect& place);

enum class Shown {
  kValues,   ///< between points colours go over into each other, unless the points are seen as squares
  kClasses,  ///< no colour that is not the raster's
};

/// The picture in field, and axes at its left and bottom that count from the outer corner of the first pixel.
void draw_map(Canvas& canvas, const PageRect& field, const PictureSurface& surface, const Raster& raster,
              Shown shown = Shown::kValues);

/// At the field's right. title: what the colours are, with its unit.
void draw_colour_bar(Canvas& canvas, const PageRect& field, const ValueRange& range, ColourScale scale,
                     const std::string& title);

}  // namespace fvd
