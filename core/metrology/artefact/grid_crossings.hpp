#pragma once

/// The crossings of a cross grid in a height field.

#include <optional>
#include <vector>

#include "core/metrology/height_field.hpp"
#include "core/metrology/study/lateral_grid.hpp"

namespace fvd::metrology {

/// A place in the image in pixels, 0 = centre of the first.
struct ImagePlace {
  double column = 0.0;
  double row = 0.0;
};

struct GridSearch {
  /// The crossing nearest to it gets the numbers 0, 0; default the image's middle. For the same grid at another height
  /// give the place of the crossing 0, 0 at the first, so that both are numbered alike.
  std::optional<ImagePlace> origin;
};

struct CrossGridPlaces {
  std::vector<GridCrossing> crossings;  ///< row after row of the grid, in the order of index_y, then index_x
  int expected = 0;                     ///< crossings whose lines should be seen on both sides within the image
  bool raised = false;                  ///< lines above the cells between them
  double line_height_um = 0.0;          ///< of the lines against the cells, > 0 either way
  double line_width_x_px = 0.0;  ///< of the lines that cross the image's x, at half of the height, across the line
  double line_width_y_px = 0.0;
  double edge_width_px = 0.0;  ///< from a line's foot to its top, as measured
};

/// Lines of equal pitch in two directions, 55 to 125 degrees apart, raised or sunk, at least two pitches in the image
/// either way; the first direction within +-45 degrees of the image's x. A line's two edges are fitted on both sides of
/// every crossing, its middle is that of the edges, and the crossing is where the middles of two lines meet. So height
/// offsets, a tilt and whatever a focus window does to both edges alike move nothing. Own definition.
/// A crossing counts where each of its lines is seen on both sides of it. What is not there, or lies far from where the
/// others have it, is left out. Refused, with a sentence: fewer than six crossings or under a quarter of those
/// expected, no two levels, no grid. Cost: up to 1 s a megapixel. context: pure.
[[nodiscard]] StudyOutcome<CrossGridPlaces> grid_crossings(const HeightField& field, const Region& region = {},
                                                           const GridSearch& search = {});

}  // namespace fvd::metrology
