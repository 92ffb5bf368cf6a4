#include "daemon/export/stage_report_files.hpp"

#include "core/base/error.hpp"

namespace fvd {

std::string feedback_name(FeedbackSource feedback) {
  switch (feedback) {
    case FeedbackSource::kMotorEncoder:
      return "motor_encoder";
    case FeedbackSource::kLinearScale:
      return "linear_scale";
    case FeedbackSource::kNone:
      break;
  }
  return "none";
}

void write_stage_report(AtomicDirectory& directory, const std::vector<StagePoint>& points, const StageReport& report,
                        const StageReportHeader& header) {
  if (points.size() != static_cast<std::size_t>(report.n)) {
    throw Error(ErrorCode::kBadInput, "the stage report is of " + std::to_string(report.n) + " points, not of these " +
                                          std::to_string(points.size()));
  }
  directory.add_file("stage_accuracy.csv", stage_report_csv(points, report));
  directory.add_file("stage_accuracy.png", stage_report_png(points, report, header));
  directory.add_file("stage_accuracy.json", stage_report_json(report, header));
}

void write_stage_report(const std::filesystem::path& final_dir, const std::vector<StagePoint>& points,
                        const StageReport& report, const StageReportHeader& header) {
  AtomicDirectory directory(final_dir);
  write_stage_report(directory, points, report, header);
  directory.commit();
}

}  // namespace fvd
