#pragma once

/// A groove laid on a field: its band, traces, edges and regions A, B, C, with the traces along x.

#include <array>
#include <optional>
#include <vector>

#include "core/metrology/step/groove_step.hpp"
#include "core/metrology/step/joint_levels.hpp"

namespace fvd::metrology {

/// Rows of a strip, the last one included.
struct RowRange {
  int first = 0;
  int last = -1;
  [[nodiscard]] int rows() const { return last - first + 1; }
};

/// Columns of A, B and C; they may reach beyond the field.
struct ColumnRange {
  int first = 0;
  int last = -1;
};

struct GrooveLayout {
  GrooveEdges edges;
  bool edges_given = false;
  RowRange band;
  std::vector<RowRange> strips;        ///< one for each trace
  std::array<ColumnRange, 3> regions;  ///< A, B, C
};

/// field: with the traces along x. Refused where the band has fewer rows than traces, or edges are not found. Throws
/// Error(kBadInput) for under five traces, or a range that is empty.
[[nodiscard]] StepOutcome<GrooveLayout> lay_out_groove(const HeightField& field, const GrooveSettings& settings);

/// Group 1 is A and B, group 2 is C, over these rows.
[[nodiscard]] PointGroups groove_groups(const HeightField& field, const GrooveLayout& layout, const RowRange& rows);

/// A, B, C over these rows, holes and what lies outside of the field counted among the points asked for.
[[nodiscard]] std::array<StepRegion, 3> groove_counts(const HeightField& field, const GrooveLayout& layout,
                                                      const RowRange& rows);

/// The region with the least share, where that is below the fraction.
[[nodiscard]] std::optional<StepRefusal> too_few_valid(const std::array<StepRegion, 3>& regions,
                                                       double min_valid_fraction);

/// Of traces along y: the field turned so that they run along x. Points stay the same bit for bit.
[[nodiscard]] HeightField transposed(const HeightField& field);

}  // namespace fvd::metrology
