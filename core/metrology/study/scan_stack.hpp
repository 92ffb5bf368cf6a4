#pragma once

/// Several scans of one surface, point by point: their mean and what each deviates from it.

#include <span>

#include "core/metrology/study/noise_study.hpp"

namespace fvd::metrology {

inline constexpr int kMostScans = 20;
inline constexpr int kFewestPoints = 100;

struct ScanStack {
  Plane<double> mean_um;      ///< NaN where a scan has a hole
  Plane<double> squares_um2;  ///< sum over the scans of the squared deviation from the mean, less a plane each
  int points = 0;             ///< valid in all scans, within the region
  double valid_fraction = 0.0;
};

/// The planes are fitted within the region and taken from every point. least_scans to kMostScans scans of equal shape
/// and pitch, the region empty or of that shape; throws Error(kBadInput) otherwise. Refused where under kFewestPoints
/// points of the region are valid in all scans, or all of them lie on one line. context: pure.
[[nodiscard]] StudyOutcome<ScanStack> stack_scans(std::span<const HeightField* const> scans, const Region& region,
                                                  int least_scans);

}  // namespace fvd::metrology
