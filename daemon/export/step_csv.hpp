#pragma once

/// The step log as a table.

#include <string>
#include <vector>

#include "core/focus/judge/suspect_slice.hpp"
#include "core/stage/step_log.hpp"

namespace fvd {

struct ExportInput;

/// CSV with a header row, units in the column names, one row per slice, decimal point, LF. exposure_start_ms counts
/// from the first measured exposure. Measured columns of a lost slice are empty; left_out is why the heights were made
/// without a slice, empty for all others.
[[nodiscard]] std::string step_csv(const StepLog& log, const std::vector<SuspectSlice>& suspects = {});

/// The exporter: step_csv() of the result.
[[nodiscard]] std::string step_csv_file(const ExportInput& input);

}  // namespace fvd
