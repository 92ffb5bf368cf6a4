#pragma once

/// A height map as a picture for people.

#include <string>

#include "core/focus/fit/height_map.hpp"
#include "core/surface/statistics.hpp"

namespace fvd {

struct ExportInput;

struct PreviewText {
  std::string title;
  std::string subtitle;
  bool simulated = false;   ///< draws a SIMULATED badge
  double pitch_x_um = 0.0;  ///< > 0: draws a scale bar
};

/// The bytes of a PNG: viridis colours (perceptually uniform, safe for the colour-blind) between the robust limits of
/// the summary, holes in neutral grey, colour bar in um. Maps wider than 1400 or higher than 1000 pixels are scaled
/// down by the mean of the valid points, small ones enlarged by a whole factor. Throws Error kInternal.
[[nodiscard]] std::string encode_preview_png(const HeightMap& map, const HeightSummary& summary,
                                             const PreviewText& text);

/// The exporter: encode_preview_png() of the input's map under the result's name.
[[nodiscard]] std::string preview_file(const ExportInput& input);

}  // namespace fvd
