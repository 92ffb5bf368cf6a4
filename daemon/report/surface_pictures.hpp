#pragma once

/// Pictures of a surface for people, as PNG files.

#include <string>

#include "daemon/report/picture_surface.hpp"
#include "daemon/result/result.hpp"

namespace fvd {

// The same surface (and result) gives the same bytes. Throw Error kInternal. context: thread-safe.

/// preview.png: heights in viridis between those that 0.5 % of the points lie below and above, holes grey, axes and
/// scale bar in um; above them the job, when and how it was measured, and the verdict; below them a table of each
/// measurement's main value and of those that have limits, or of the map's values where nothing was evaluated.
[[nodiscard]] std::string overview_png(const PictureSurface& surface, const Result& result);

/// Standard errors of the heights with axes and colour bar in um, between the 0.5 % and 99.5 % values, holes grey. The
/// words "not known" where the surface has none.
[[nodiscard]] std::string sigma_png(const PictureSurface& surface);

/// Why points are holes: a colour a reason, with a legend that counts them. A point with several reasons has the colour
/// of the first in the legend; it counts in all of them.
[[nodiscard]] std::string holes_png(const PictureSurface& surface);

/// The surface seen from the front at an angle, shaded, with its dimensions and the exaggeration of its heights.
[[nodiscard]] std::string view3d_png(const PictureSurface& surface);

}  // namespace fvd
