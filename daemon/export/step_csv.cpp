#include "daemon/export/step_csv.hpp"

#include <algorithm>
#include <chrono>

#include "daemon/export/csv_row.hpp"
#include "daemon/export/export_input.hpp"

namespace fvd {

namespace {

constexpr int kMeasuredColumns = 6;

}  // namespace

std::string step_csv(const StepLog& log) {
  std::string out =
      "index,measured,commanded_um,quantised_um,commanded_counts,move_ms,settle_polls,triggers,"
      "measured_um,measured_sd_um,position_samples,error_um,frame_id,exposure_start_ms\n";
  const auto first = std::find_if(log.begin(), log.end(), [](const StepRecord& step) { return step.measured; });
  for (const StepRecord& step : log) {
    CsvRow row(out);
    row.integer(step.index).integer(step.measured ? 1 : 0).number(step.commanded_um, 6).number(step.quantised_um, 6);
    row.integer(step.commanded_counts).number(step.move_ms, 3).integer(step.settle_polls).integer(step.triggers);
    if (!step.measured) {
      row.empty(kMeasuredColumns);
      continue;
    }
    row.number(step.measured_um, 6).number(step.measured_sd_um, 6).integer(step.position_samples);
    row.number(step.error_um, 6).integer(step.frame_id);
    row.number(std::chrono::duration<double, std::milli>(step.exposure_start - first->exposure_start).count(), 3);
  }
  return out;
}

std::string step_csv_file(const ExportInput& input) { return step_csv(input.data.steps); }

}  // namespace fvd
