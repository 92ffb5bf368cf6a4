#include "daemon/export/step_csv.hpp"

#include <algorithm>
#include <chrono>
#include <string_view>

#include "daemon/export/csv_row.hpp"
#include "daemon/export/export_input.hpp"

namespace fvd {

namespace {

constexpr int kMeasuredColumns = 6;

std::string_view reason_left_out(int index, const std::vector<SuspectSlice>& suspects) {
  const auto left_out = std::find_if(suspects.begin(), suspects.end(), [index](const SuspectSlice& slice) {
    return slice.index == index && slice.done == SuspectDone::kLeftOut;
  });
  return left_out == suspects.end() ? std::string_view{} : suspect_reason_name(left_out->reason);
}

}  // namespace

std::string step_csv(const StepLog& log, const std::vector<SuspectSlice>& suspects) {
  std::string out =
      "index,measured,commanded_um,quantised_um,commanded_counts,move_ms,settle_polls,triggers,"
      "measured_um,measured_sd_um,position_samples,error_um,frame_id,exposure_start_ms,left_out\n";
  const auto first = std::find_if(log.begin(), log.end(), [](const StepRecord& step) { return step.measured; });
  for (const StepRecord& step : log) {
    CsvRow row(out);
    row.integer(step.index).integer(step.measured ? 1 : 0).number(step.commanded_um, 6).number(step.quantised_um, 6);
    row.integer(step.commanded_counts).number(step.move_ms, 3).integer(step.settle_polls).integer(step.triggers);
    if (!step.measured) {
      row.empty(kMeasuredColumns).word(reason_left_out(step.index, suspects));
      continue;
    }
    row.number(step.measured_um, 6).number(step.measured_sd_um, 6).integer(step.position_samples);
    row.number(step.error_um, 6).integer(step.frame_id);
    row.number(std::chrono::duration<double, std::milli>(step.exposure_start - first->exposure_start).count(), 3);
    row.word(reason_left_out(step.index, suspects));
  }
  return out;
}

std::string step_csv_file(const ExportInput& input) { return step_csv(input.data.steps, input.data.suspects); }

}  // namespace fvd
