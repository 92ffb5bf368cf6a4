#pragma once

/// Percentiles of magnitudes that are not kept.

#include <array>
#include <cstdint>
#include <optional>

namespace fvd {

/// Counts in bins of equal ratio, 16 to an octave from 1e-5 to about 5.5e6 of the caller's unit. A percentile is exact
/// to half a bin: within 2.2 % of the value. A value below 1e-5 counts as 0, one above the range as the end of the
/// range. A plain struct of 5 kB, which is stored as it is. context: one thread at a time.
struct MagnitudeHistogram {
  static constexpr int kBinsPerOctave = 16;
  static constexpr int kOctaves = 39;
  static constexpr double kLowest = 1e-5;                                           ///< lower end of the range
  static constexpr std::size_t kBins = std::size_t{kBinsPerOctave} * kOctaves + 1;  ///< the first holds the zeros

  std::array<std::uint64_t, kBins> counts{};

  /// magnitude: finite, >= 0.
  void add(double magnitude);
  void merge(const MagnitudeHistogram& other);
  [[nodiscard]] std::uint64_t total() const;
  /// The value of rank ceil(p n) (nearest rank) for p in [0, 1]: the geometric middle of its bin, 0 in the bin of the
  /// zeros; nothing when empty.
  [[nodiscard]] std::optional<double> quantile(double p) const;
};

}  // namespace fvd
