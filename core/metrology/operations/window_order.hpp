#pragma once

/// The median of a window that slides along a row.

#include <cstddef>
#include <vector>

namespace fvd::metrology {

/// The valid values of a window of window x window points, columns replaced one by one. Keeps one of the values and how
/// many are below it, so that the next median is found by few steps from the last one. Exact. context: one thread.
class WindowOrder {
 public:
  explicit WindowOrder(int window);

  /// Every point becomes a hole.
  void clear();
  /// Column `slot` (0 to window - 1) gets the values of `window` points; NaN = hole.
  void replace_column(int slot, const double* values);
  [[nodiscard]] int valid() const { return valid_; }
  /// The mean of the two middle ones where the number is even. valid() > 0.
  [[nodiscard]] double median();
  /// How many values lie nearer to `centre` than `reach`.
  [[nodiscard]] int count_within(double centre, double reach) const;
  /// Median of the distances from `centre`, by sorting: slow. valid() > 0.
  [[nodiscard]] double median_distance(double centre);

 private:
  void seek(int rank);

  int window_;
  std::vector<double> values_;   ///< column after column, filled up with NaN to a whole number of lanes
  std::vector<double> scratch_;  ///< of median_distance()
  int valid_ = 0;
  double pivot_;
  int below_ = 0;     ///< values < pivot_
  int at_pivot_ = 0;  ///< values == pivot_
};

}  // namespace fvd::metrology
