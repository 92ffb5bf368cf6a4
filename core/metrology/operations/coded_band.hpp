#pragma once

/// The heights of some rows as 16-bit codes.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/metrology/height_field.hpp"

namespace fvd::metrology {

/// Codes of a band of rows with `reach` rows above and below; what lies beyond the image is a hole. A code is the whole
/// number of steps from a height in the middle of the band's heights, rounded down; the step is a small part of the
/// difference between neighbours. Coarser than the heights, so that it serves to rule out, not to decide.
class CodedBand {
 public:
  /// Rows [first, end) of the field.
  CodedBand(const HeightField& field, int first, int end, int reach);

  [[nodiscard]] double step_um() const { return step_um_; }
  /// 2 * reach + 1 codes: those of `column` from `reach` rows above `row` downwards.
  [[nodiscard]] const std::int16_t* around(int column, int row) const {
    return codes_.data() + static_cast<std::ptrdiff_t>(column) * rows_ + (row - first_);
  }
  [[nodiscard]] int code(int column, int row) const { return around(column, row)[reach_]; }

 private:
  void choose_step(const HeightField& field, int end);

  int first_;
  int reach_;
  int rows_;  ///< with those above and below
  double step_um_ = 1.0;
  double middle_um_ = 0.0;
  std::vector<std::int16_t> codes_;  ///< column after column
};

}  // namespace fvd::metrology
