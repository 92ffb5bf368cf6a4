#pragma once

/// The constants that a job is measured with.

#include <functional>

#include "daemon/calibration/calibration_book.hpp"
#include "daemon/recipes/recipe.hpp"
#include "daemon/result/result_data.hpp"

namespace fvd {

/// How far the values of a recipe scatter, from its newest gauge study; empty where there is none. Throws Error.
using RepeatabilityOf = std::function<RepeatabilityMap(const Recipe& recipe)>;

/// Notes the calibration in force for the result's objective, or where none is confirmed for the recipe's; the
/// reference map where the recipe asks for it; the repeatability. No calibration, with a warning, where a part of it
/// was found with a simulator and the result is of an instrument. What cannot be read is a warning of the result and
/// missing in it: a measurement that needs it says so. repeatability may be empty. Never throws Error. context: blocks
/// for files.
void note_constants(const Recipe& recipe, const CalibrationBook& calibrations, const RepeatabilityOf& repeatability,
                    ResultData& result);

}  // namespace fvd
