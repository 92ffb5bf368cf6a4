#pragma once

/// The shaded view with the dimensions of what it shows. Only sources of this folder include it.

#include "daemon/report/canvas.hpp"
#include "daemon/report/picture_surface.hpp"

namespace fvd {

/// In the place, with a line of words below that states the exaggeration.
void draw_view(Canvas& canvas, const PageRect& place, const PictureSurface& surface);

}  // namespace fvd
