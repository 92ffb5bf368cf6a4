#pragma once

/// The error that the five-sample fit makes beside a gap in z, where a slice is missing.
///
/// The samples about such a peak are not symmetric, so what the scan's curves have beside the fit's shape (curve_shape)
/// does not cancel: 0.02 widths of the curve at 0.4 widths a step. For curves of the scan's exponent and width the
/// fit's vertex is computed at 33 places about each sample that has a gap beside it, and heights are read backwards
/// from that.

#include <vector>

#include "core/focus/fit/curve_shape.hpp"
#include "core/focus/kernels/focus_kernels.hpp"

namespace fvd {

/// context: const members from many threads.
class GapBias {
 public:
  /// z_um: of each sample. shape: of the scan; with a width of 0 nothing is corrected.
  GapBias(const std::vector<double>& z_um, const CurveShape& shape);

  /// Of the five-sample fit's heights of one row; NaN stays. Shape [width].
  void correct(const CurveRow& row, int width, float* height_m) const noexcept;

 private:
  struct Vertex {
    double fitted_m;
    double true_m;
  };
  struct Beside {
    std::vector<Vertex> vertices;  // fitted_m rises
  };
  std::vector<int> table_of_;  // by sample; -1 = no gap beside it
  std::vector<Beside> tables_;
};

}  // namespace fvd
