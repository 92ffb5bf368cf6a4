#pragma once

/// A cross section as a plot. Only sources of this folder include it.

#include <string>

#include "daemon/report/canvas.hpp"
#include "daemon/report/picture_surface.hpp"
#include "daemon/result/cross_section.hpp"

namespace fvd {

/// The measured heights along the section, its regions hatched and named, what was not measured hatched in grey. title:
/// above the plot, cut where it is too long.
void draw_profile(Canvas& canvas, const PageRect& place, const PictureSurface& surface, const CrossSection& section,
                  const std::string& title);

}  // namespace fvd
