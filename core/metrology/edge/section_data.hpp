#pragma once

/// The points of a height field as sections across the edge.

#include <vector>

#include "core/metrology/edge/edge_curve.hpp"
#include "core/metrology/edge/edge_options.hpp"
#include "core/metrology/edge/edge_result.hpp"
#include "core/metrology/height_field.hpp"

namespace fvd::metrology::edge {

/// A pixel's part in a section.
struct SectionPoint {
  int column = 0;
  int row = 0;
  int node = 0;        ///< index of the node it is averaged into
  double share = 0.0;  ///< of that node's height; the shares of a node sum to 1 / stretch
};

/// One section: the points of sections_every_um of the edge, averaged along it over half a pitch of s each.
struct SectionData {
  double along_um = 0.0;
  EdgeFrame frame;
  EdgeReason state = EdgeReason::kNone;  ///< kFlankUnmeasured, kApexUnmeasured
  std::vector<double> s_um;              ///< of the nodes, rising
  std::vector<double> h_um;              ///< at right angles to the edge in space
  std::vector<double> weight;            ///< 1 / sigma^2 of the points, summed; 1 a point where sigma is not known
  std::vector<SectionPoint> points;
  long possible = 0;  ///< pixels of the region that lie in the section, holes too
};

/// Sections that stand beside each other along the whole edge; what is left over is shared by both ends. Nodes without
/// a point are not there: nothing is filled.
[[nodiscard]] std::vector<SectionData> cut_sections(const HeightField& field, const Region& region,
                                                    const EdgeCurve& curve, const EdgeOptions& options);

}  // namespace fvd::metrology::edge
