#pragma once

/// What differs between a scan upwards and one downwards.

#include "core/metrology/height_field.hpp"
#include "core/metrology/study/noise_study.hpp"

namespace fvd::metrology {

struct Hysteresis {
  double mean_um = 0.0;    ///< heights seen downwards - heights seen upwards, mean over the points
  double u_mean_um = 0.0;  ///< standard error of the mean, from the rest, with errors that neighbours share
  double slope_x = 0.0;    ///< of the plane through the differences, rise over run
  double slope_y = 0.0;
  double rest_um = 0.0;  ///< Sq of the differences less their plane
  int points = 0;        ///< valid in both, within the region
  double valid_fraction = 0.0;
};

/// Least squares. Own definition. Refused where fewer than 100 points are valid in both or they lie on one line. Throws
/// Error(kBadInput) where shapes or pitches differ. context: pure.
[[nodiscard]] StudyOutcome<Hysteresis> hysteresis(const HeightField& up, const HeightField& down,
                                                  const Region& region = {});

}  // namespace fvd::metrology
