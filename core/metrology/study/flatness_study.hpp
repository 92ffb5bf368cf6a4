#pragma once

/// Flatness deviation of the instrument from scans of a flat.

#include <span>

#include "core/metrology/study/noise_study.hpp"

namespace fvd::metrology {

struct FlatnessStudy {
  double flatness_um = 0.0;  ///< z_FLT: Sz of the mean map after a plane
  int positions = 0;
  int points = 0;
  double valid_fraction = 0.0;
  /// The mean of the maps less their planes, with the standard error of that mean (from the scatter over the positions;
  /// unknown from one position). Holes where a position has one.
  HeightField reference;
};

/// ISO 25178-600:2019, 3.1.12, by ISO 25178-700: maps of a flat at n positions, each S-filtered by the caller, each
/// less its plane, averaged so that the flat's own form and the noise fade. Refusals and throws as measurement_noise(),
/// from one map on.
[[nodiscard]] StudyOutcome<FlatnessStudy> flatness_deviation(std::span<const HeightField* const> maps,
                                                             const Region& region = {});

}  // namespace fvd::metrology
