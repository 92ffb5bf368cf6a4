#include "daemon/jobs/job_constants.hpp"

#include "core/base/error.hpp"
#include "daemon/pipeline/evaluation_input.hpp"
#include "daemon/surface_files/reference_map.hpp"

namespace fvd {

namespace {

/// As a whole: a version without some of its constants would be another one by the same name.
void drop_those_of_a_simulator(ResultData& result) {
  if (result.simulated || !result.calibration) return;
  Calibration rest = *result.calibration;
  if (!drop_simulated(rest)) return;
  result.warnings.push_back(
      {"calibration_simulated", "constants of the calibration " + rest.id +
                                    " were found with a simulator: it is not used; calibrate this instrument"});
  result.calibration.reset();
}

}  // namespace

void note_constants(const Recipe& recipe, const CalibrationBook& calibrations, const RepeatabilityOf& repeatability,
                    ResultData& result) {
  result.calibration = calibrations.current(result.objective.empty() ? recipe.objective : result.objective);
  drop_those_of_a_simulator(result);
  const bool has_map =
      result.calibration && result.calibration->flatness && !result.calibration->flatness->reference.empty();
  if (has_map && asks_for_reference_map(recipe.evaluation)) {
    try {
      result.flatness_reference = read_reference_map(calibrations.folder(), result.calibration->flatness->reference);
    } catch (const Error& failure) {
      result.warnings.push_back({"reference_map", failure.what()});
    }
  }
  if (!repeatability) return;
  try {
    result.repeatability = repeatability(recipe);
  } catch (const Error& failure) {
    result.warnings.push_back(
        {"repeatability", std::string("U does not contain what gauge studies found: ") + failure.what()});
  }
}

}  // namespace fvd
