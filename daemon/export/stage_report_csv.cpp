#include "daemon/export/csv_row.hpp"
#include "daemon/export/stage_report_files.hpp"

namespace fvd {

namespace {

constexpr int kMeasuredColumns = 4;
constexpr int kUmDecimals = 6;

}  // namespace

std::string stage_report_csv(const std::vector<StagePoint>& points, const StageReport& report) {
  std::string out =
      "index,time_s,run,direction,commanded_um,quantised_um,quantisation_um,settle_ms,move_ms,polls,temperature_c,"
      "measured_um,error_um,error_to_command_um,fit_residual_um\n";
  int index = 0;
  for (const StagePoint& p : points) {
    CsvRow row(out);
    row.integer(index++).number(p.time_s, 6).integer(p.run).integer(p.direction);
    row.number(p.commanded_um, kUmDecimals).number(p.quantised_um, kUmDecimals);
    row.number(p.quantised_um - p.commanded_um, kUmDecimals);
    row.number(p.settle_ms, 3).number(p.move_ms, 3).integer(p.polls).number(p.temperature_c, 3);
    if (!report.observable) {
      row.empty(kMeasuredColumns);
      continue;
    }
    const double error_um = p.measured_um - p.quantised_um;
    row.number(p.measured_um, kUmDecimals).number(error_um, kUmDecimals);
    row.number(p.measured_um - p.commanded_um, kUmDecimals);
    std::optional<double> residual_um;
    if (report.fit) {
      residual_um =
          error_um - fitted_error_um(*report.fit, p.quantised_um, p.direction) - fitted_drift_um(*report.fit, p);
    }
    row.number(residual_um, kUmDecimals);
  }
  return out;
}

}  // namespace fvd
