#pragma once

/// Measurement noise from repeated scans of one part.

#include <optional>
#include <span>
#include <string>
#include <variant>

#include "core/metrology/height_field.hpp"

namespace fvd::metrology {

struct StudyRefusal {
  std::string text;  ///< one sentence with figures
};

template <typename T>
using StudyOutcome = std::variant<T, StudyRefusal>;

struct NoiseStudy {
  double noise_um = 0.0;  ///< N_M: of two scans Sq(difference) / sqrt(2); of n scans pooled, about their mean
  int scans = 0;
  int points = 0;                    ///< valid in all scans, within the region
  double valid_fraction = 0.0;       ///< of the region
  Plane<float> noise_map_um;         ///< standard deviation of each point over the scans; NaN where not valid in all
  std::optional<double> over_sigma;  ///< N_M over the quadratic mean of the sigma maps: 1 where sigma is true
};

/// ISO 25178-700:2022 and ISO 25178-600:2019, 3.1.15: measurement noise, by subtraction. From each scan its difference
/// from the mean of all is taken, less a plane, so that drift and tilt do not count. Two to twenty scans of equal shape
/// and pitch; throws Error(kBadInput) otherwise. Refused where fewer than 100 points are valid in all scans.
/// context: pure.
[[nodiscard]] StudyOutcome<NoiseStudy> measurement_noise(std::span<const HeightField* const> scans,
                                                         const Region& region = {});

}  // namespace fvd::metrology
