#pragma once

/// The step-accuracy report as files: stage_accuracy.json, .csv and .png.

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/stage/stage_report.hpp"
#include "daemon/export/atomic_directory.hpp"

namespace fvd {

/// Where the report comes from. Texts are UTF-8, empty = unknown; the picture shows ASCII only.
struct StageReportHeader {
  std::string profile;  ///< name of the drive profile
  std::string address;  ///< of the drive
  std::chrono::system_clock::time_point date;
  std::string software_version;
  std::optional<bool> simulated;  ///< absent = unknown: a drive at the end of a line may be a simulator
};

/// "none", "motor_encoder" or "linear_scale", as in drive profiles.
[[nodiscard]] std::string feedback_name(FeedbackSource feedback);

/// Pretty-printed JSON, ASCII only, keys in a fixed order and with units; null for whatever is unknown or not
/// observable, with the reasons as sentences in "caveats". Positions to 1 pm, alpha_z to 1e-9.
[[nodiscard]] std::string stage_report_json(const StageReport& report, const StageReportHeader& header);

/// One line per point in the order given, header row, decimal point, LF. Columns that need the measured position are
/// empty where the report is not observable.
[[nodiscard]] std::string stage_report_csv(const std::vector<StagePoint>& points, const StageReport& report);

/// The bytes of a PNG, 1200 x 800: measured - quantised over position, approaches from below and above, the fitted
/// curve, the main figures. Without feedback the words "not observable". Throws Error kInternal.
[[nodiscard]] std::string stage_report_png(const std::vector<StagePoint>& points, const StageReport& report,
                                           const StageReportHeader& header);

/// Adds the three files to a directory that is being written. report: of these points, else Error kBadInput. Throws
/// Error kStorageFull, kStorageWrite, kInternal.
void write_stage_report(AtomicDirectory& directory, const std::vector<StagePoint>& points, const StageReport& report,
                        const StageReportHeader& header);

/// The three files in a directory that appears whole or not at all. final_dir must not exist, its parent must.
void write_stage_report(const std::filesystem::path& final_dir, const std::vector<StagePoint>& points,
                        const StageReport& report, const StageReportHeader& header);

}  // namespace fvd
