#pragma once

/// Where a groove's regions and traces lie in the pixels of a field.

#include <array>
#include <vector>

#include "core/metrology/height_field.hpp"
#include "core/metrology/step/groove_step.hpp"
#include "core/metrology/step/joint_levels.hpp"

namespace fvd::metrology {

/// Indices first..last, last included; none where last < first.
struct IndexRange {
  int first = 0;
  int last = -1;
  [[nodiscard]] int count() const { return last < first ? 0 : last - first + 1; }
};

/// The points of one trace, or of the band: `rows` stands for columns where the traces run along y.
struct GrooveStrip {
  double from_um = 0.0;
  double to_um = 0.0;
  IndexRange rows;  ///< within the field
};

struct GrooveLayout {
  Across across = Across::kX;
  GrooveEdges edges;
  bool edges_given = false;
  std::array<IndexRange, 3> along;  ///< A, B, C; may reach out of the field
  GrooveStrip band;
  std::vector<GrooveStrip> strips;  ///< one a trace

  [[nodiscard]] SlopeAxes along_axis() const { return across == Across::kX ? SlopeAxes::kX : SlopeAxes::kY; }
  /// A row has no slope across itself.
  [[nodiscard]] SlopeAxes axes_of(const GrooveStrip& strip) const {
    return strip.rows.count() > 1 ? SlopeAxes::kBoth : along_axis();
  }
};

/// Points whose centres lie within from..to; a centre on a border belongs to the range. context: pure, as the next
/// ones.
[[nodiscard]] IndexRange centres_within(FromTo range, double pitch_um);

/// Finds the edges if they are not given. Errors as iso5436_a1; the regions' holes are not looked at.
[[nodiscard]] StepOutcome<GrooveLayout> lay_out_groove(const HeightField& field, const GrooveSettings& settings);

/// Points and mean heights of A, B, C in a strip.
[[nodiscard]] std::array<StepRegion, 3> count_regions(const HeightField& field, const GrooveLayout& layout,
                                                      const GrooveStrip& strip);

/// Groups kShoulders (A and B) and kBottom (C) in a strip. At least a point of each region lies in the field.
[[nodiscard]] PointGroups groove_groups(const HeightField& field, const GrooveLayout& layout, const GrooveStrip& strip);
inline constexpr int kShoulders = 1;
inline constexpr int kBottom = 2;

/// All zero, for the sum over traces.
[[nodiscard]] WeightMap empty_weights(const HeightField& field, const GrooveLayout& layout);

}  // namespace fvd::metrology
