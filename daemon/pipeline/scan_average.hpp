#pragma once

/// One height map of several scans of the same part, and how far they scatter.

#include <cstddef>
#include <optional>
#include <vector>

#include "core/focus/fit/height_map.hpp"
#include "core/image/image.hpp"
#include "daemon/result/repeated_scans.hpp"
#include "daemon/result/result.hpp"

namespace fvd {

/// Mean z = sum z_k / n. Scatter s = sqrt(sum (z_k - z)^2 / (n - 1)), of single scans (own definition, both by
/// Welford's recurrence). Standard error of the mean u = sqrt(sum sigma_k^2) / n, from the scans' own standard errors:
/// a scatter of a few scans is itself uncertain by 1 / sqrt(2 (n - 1)). A point is valid only where every scan has it;
/// else it keeps the reasons of all of them. context: one thread.
class ScanAverage {
 public:
  /// What it keeps per point until finish(), and the scatter.
  static constexpr std::size_t kBytesPerPixel =
      2 * sizeof(double) + sizeof(float) + sizeof(MaskReasons) + sizeof(float);

  /// width, height >= 1.
  ScanAverage(int width, int height);

  /// map: of this size.
  void add(const HeightMap& map);
  [[nodiscard]] int scans() const noexcept { return scans_; }

  /// Puts mean heights, their standard errors and the reasons of all scans in place of those of `map`, the last that
  /// was added; the rest of it stays that scan's. After two scans or more.
  [[nodiscard]] RepeatedScans finish(HeightMap& map) const;

 private:
  int scans_ = 0;
  Plane<double> mean_m_;
  Plane<double> squares_m2_;    ///< sum of squared deviations from the mean
  Plane<float> variance_m2_;    ///< sum of squared standard errors
  Plane<MaskReasons> reasons_;  ///< of all scans
};

/// Where the scans scatter by more than three times what their standard errors tell: what they have in common, as drift
/// from scan to scan, is in no standard error. map: as ScanAverage::finish() left it. context: pure.
[[nodiscard]] std::optional<Warning> scatter_warning(const RepeatedScans& repeated, const HeightMap& map);

}  // namespace fvd
