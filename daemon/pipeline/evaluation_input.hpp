#pragma once

/// What an evaluation takes, from a job's data or from the folder of its result: the same values, bit for bit.

#include <filesystem>

#include "core/surface/surface.hpp"
#include "core/surface/surface_ref.hpp"
#include "daemon/evaluation/evaluation_context.hpp"
#include "daemon/result/result.hpp"
#include "daemon/result/result_data.hpp"

namespace fvd {

/// A copy of the measured heights, standard errors and reasons of holes, with pitch and window.
[[nodiscard]] Surface evaluated_surface(const ResultData& data);

/// The same without a copy: data outlives it, and its map does not change.
[[nodiscard]] SurfaceRef surface_to_evaluate(const ResultData& data);

/// The slices' z with their uncertainty: the scatter of the positions during the exposure and the encoder's resolution;
/// none where neither is known. Rounded as the files of a result have them. With the constants, the temperature and the
/// repeatability that the result tells.
[[nodiscard]] EvaluationContext evaluation_context(const ResultData& data);

/// The window of the surface and its lateral period, as the result tells them.
void note_window(const Result::Focus& focus, Surface& surface);

/// The same from step_log.csv in the folder; without slices where that file is not there. The reference map of
/// the calibration is not read: see daemon/surface_files/reference_map.hpp. Throws Error kBadInput where the log is
/// none.
[[nodiscard]] EvaluationContext read_evaluation_context(const std::filesystem::path& folder, const Result& result);

}  // namespace fvd
