#include "daemon/jobs/job_constants.hpp"

#include "core/base/error.hpp"
#include "daemon/pipeline/reference_input.hpp"
#include "daemon/surface_files/reference_map.hpp"

namespace fvd {

void note_constants(const Recipe& recipe, const CalibrationBook& calibrations, const RepeatabilityOf& repeatability,
                    ResultData& result) {
  result.calibration = calibrations.current(result.objective.empty() ? recipe.objective : result.objective);
  if (!result.calibration && !calibrations.versions().empty()) {
    const std::string objective = result.objective.empty() ? recipe.objective : result.objective;
    result.warnings.push_back(
        {"calibration_of_others",
         "there are constants, but none " +
             (objective.empty() ? std::string("without an objective's name") : "of the objective " + objective) +
             ": heights are as the axis gave them"});
  }
  // As a whole: a version without some of its constants would be another one by the same name.
  if (!result.simulated && result.calibration && has_simulated(*result.calibration)) {
    result.warnings.push_back({"calibration_simulated", "constants of the calibration " + result.calibration->id +
                                                            " were found with a simulator: it is not used; calibrate "
                                                            "this instrument"});
    result.calibration.reset();
  }
  const bool has_map =
      result.calibration && result.calibration->flatness && !result.calibration->flatness->reference.empty();
  if (has_map && asks_for_reference(recipe.evaluation)) {
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
