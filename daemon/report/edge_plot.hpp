#pragma once

/// A cutting edge along its line, as plots. Only sources of this folder include it.

#include <optional>
#include <string>
#include <vector>

#include "daemon/report/canvas.hpp"
#include "daemon/result/evaluation_result.hpp"

namespace fvd {

/// What the details of a measurement tell of its edge.
struct EdgeAlong {
  struct Section {
    double along_um = 0.0;
    std::optional<double> value;  ///< the measurement's main value; absent = the section could not be measured
  };
  struct Notch {
    double along_um = 0.0;
    double depth_um = 0.0;
    double width_um = 0.0;
  };
  struct Place {
    double along_um = 0.0;
    std::optional<double> missing_um;  ///< of the edge line's form; absent = not measured
  };
  std::vector<Section> sections;  ///< in order along the edge
  std::vector<Notch> notches;
  std::vector<Place> line;  ///< the edge line; empty in results that do not tell it
  bool looked_for_notches = false;
};

/// Nothing where the measurement is no cutting edge, or tells no sections.
[[nodiscard]] std::optional<EdgeAlong> edge_along(const EvaluatedMeasurement& measurement);

/// name: of the value that is drawn, with its unit. Above the value of each section over the place along the edge,
/// below the edge's line with its notches; sections that were not measured hatched in both.
void draw_edge(Canvas& canvas, const PageRect& place, const EdgeAlong& edge, const std::string& name);

}  // namespace fvd
