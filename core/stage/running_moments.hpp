#pragma once

/// Mean, standard deviation and largest magnitude of values that are not kept.

#include <cstdint>
#include <optional>

namespace fvd {

/// Welford's recurrence ("Note on a method for calculating corrected sums of squares and products", Technometrics 4,
/// 1962); merged as in Chan, Golub and LeVeque (1983). A plain struct, which is stored as it is. context: one thread at
/// a time.
struct RunningMoments {
  std::uint64_t n = 0;
  double mean = 0.0;
  double sum_of_squares = 0.0;  ///< about the mean, square of the unit of the values
  double max_magnitude = 0.0;

  /// value: finite.
  void add(double value);
  void merge(const RunningMoments& other);
  /// Sample standard deviation; nothing with fewer than two values.
  [[nodiscard]] std::optional<double> sd() const;
  /// False for a state that no values can have led to.
  [[nodiscard]] bool consistent() const;
};

}  // namespace fvd
