#pragma once

/// The measured heights of a curve's samples: of slices, or of bins of successive slices.

#include <vector>

#include "core/focus/kernels/focus_kernels.hpp"

namespace fvd {

/// context: one thread.
class SampleHeights {
 public:
  /// Allocates memory for max_slices. bin_slices >= 1.
  SampleHeights(int bin_slices, int max_slices);

  void push(double z_um);

  [[nodiscard]] int slices() const noexcept { return slices_; }
  /// Number of complete bins, plus one if a bin is being filled.
  [[nodiscard]] int samples() const noexcept { return (slices_ + bin_slices_ - 1) / bin_slices_; }
  /// Slices in the last, incomplete bin; 0 where there is none.
  [[nodiscard]] int pending() const noexcept { return slices_ % bin_slices_; }
  /// Mean measured z of each sample's slices.
  [[nodiscard]] std::vector<double> means_um() const;

 private:
  int bin_slices_;
  int slices_ = 0;
  std::vector<double> sums_um_;  // one per sample
};

/// One entry per sample. z_um: at least one.
[[nodiscard]] std::vector<HeightEntry> height_table(const std::vector<double>& z_um);

/// Median distance of successive samples, 0 for fewer than two.
[[nodiscard]] double median_step_um(const std::vector<double>& z_um);

}  // namespace fvd
