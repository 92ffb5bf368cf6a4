#pragma once

/// What stands at the top and at the bottom of a report's pages. Only sources of this folder include it.

#include <string>

#include "daemon/report/canvas.hpp"
#include "daemon/result/result.hpp"

namespace fvd {

/// Part, verdict, job, time, recipe, instrument, calibration, SIMULATED; returns where the page goes on below.
[[nodiscard]] double draw_head(Canvas& canvas, const PageRect& page, const Result& result);

/// One line: the part, and that the page goes on from another.
[[nodiscard]] double draw_short_head(Canvas& canvas, const PageRect& page, const Result& result);

/// Software and the surface's digest, the page's number; the last page tells how many there are.
void draw_foot(Canvas& canvas, const PageRect& page, const Result& result, const std::string& sha256, int number,
               bool goes_on);

/// The part id, or the job's, or "height map".
[[nodiscard]] std::string report_title(const Result& result);

}  // namespace fvd
