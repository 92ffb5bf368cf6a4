#pragma once

/// The instrument's noise beside texture values, and the other conditions that every one of them is told with.

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "core/metrology/height_field.hpp"
#include "daemon/evaluation/measure_kinds.hpp"

namespace fvd {

/// What a perfectly flat surface would read.
struct NoiseFloor {
  std::optional<double> sq_um;  ///< absent where neither standard errors nor N_M are known
  bool of_calibration = false;  ///< N_M, which was seen; else what the standard errors tell
};

/// N_M of the calibration, over alpha_z; behind filters times what they left of the surface's standard errors, root
/// mean square over root mean square, where these are known, and at most 1. Without a calibration of the noise the
/// root mean square of the standard errors in the region. Own definition.
[[nodiscard]] NoiseFloor noise_floor(const MeasurementInput& input, const metrology::Region& region);

/// The value is under twice the floor. False where either is not known.
[[nodiscard]] bool is_below_noise(std::optional<double> sq_um, const NoiseFloor& floor) noexcept;

/// null where there is no number.
[[nodiscard]] nlohmann::ordered_json number_or_null(std::optional<double> value);

/// noise_floor_Sq_um, noise_floor_from, window_um, S_um, L_um, S_effective_um: the longer of the S filter and the
/// lateral period.
[[nodiscard]] nlohmann::ordered_json texture_conditions(const MeasurementInput& input, const NoiseFloor& floor);

void warn_below_noise(double sq_um, const NoiseFloor& floor, EvaluatedMeasurement& made);

/// What no texture value's budget contains, beside instrument_not_evaluated().
[[nodiscard]] std::vector<std::string> texture_not_evaluated(const MeasurementInput& input);

/// Why the measurement is invalid; empty where enough points are valid.
[[nodiscard]] std::string too_few_valid(double valid_fraction, const PlannedMeasurement& planned);

}  // namespace fvd
