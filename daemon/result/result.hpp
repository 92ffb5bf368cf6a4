#pragma once

/// The result of a job or of recorded slices: everything but its pixels.

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/focus/judge/suspect_slice.hpp"
#include "core/focus/measure/focus_settings.hpp"
#include "core/scan/frame_ledger.hpp"
#include "core/scan/scan_plan.hpp"
#include "core/stage/stage_accuracy.hpp"
#include "core/surface/statistics.hpp"
#include "core/surface/verdict.hpp"
#include "daemon/result/calibration.hpp"
#include "daemon/result/evaluation_result.hpp"
#include "daemon/result/repeatability.hpp"

namespace fvd {

/// One value that was measured, and what was decided about it.
struct MeasuredValue {
  std::string name;             ///< unique in the result
  std::string kind;             ///< what kind of quantity: "height", "sigma", "fraction"
  std::optional<double> value;  ///< in `unit`; absent = could not be measured
  std::string unit;
  std::optional<double> u;           ///< standard uncertainty, in `unit`
  std::optional<double> expanded_u;  ///< k * u
  std::optional<double> k;           ///< coverage factor
  std::size_t points = 0;            ///< valid points that the value rests on
  double valid_fraction = 0.0;       ///< valid share of the points it was to rest on, 0..1
  std::optional<Limits> limits;
  std::optional<Verdict> verdict;  ///< present where limits are
  bool operator==(const MeasuredValue&) const = default;
};

/// What lowers trust in the result.
struct Warning {
  std::string code;  ///< stable, for programs
  std::string text;  ///< for people
  bool operator==(const Warning&) const = default;
};

/// Wall-clock durations of the job's phases in ms; NaN = unknown.
struct PhaseTimes {
  double prepare_ms = 0.0;                 ///< devices, homing, take-up
  double scan_ms = 0.0;                    ///< first move to last frame
  double finish_ms = 0.0;                  ///< last frame to height map
  double write_ms = 0.0;                   ///< of the files that the verdict waited for
  std::optional<double> evaluate_ms = {};  ///< of the measurements; absent where there are none
  std::optional<double> follow_ms = {};    ///< of the files that followed; absent while they are pending, or none did
  bool operator==(const PhaseTimes&) const = default;
};

/// What the number of slices in a bin was taken from.
enum class BinChoice {
  kRecipe,        ///< the recipe, or an option, tells it or the curve's width
  kEarlierScans,  ///< the curve's width in the recipe's last good scans
  kSlices,        ///< the curve's width in the slices themselves, which were looked at first
  kUnknownWidth,  ///< nothing was known of the width: no bins
};
inline constexpr std::array kAllBinChoices{BinChoice::kRecipe, BinChoice::kEarlierScans, BinChoice::kSlices,
                                           BinChoice::kUnknownWidth};

/// "recipe", "earlier_scans", "slices", "unknown_width".
[[nodiscard]] std::string_view bin_choice_name(BinChoice choice) noexcept;
[[nodiscard]] std::optional<BinChoice> bin_choice_from_name(std::string_view name) noexcept;

/// By what the drift of the slices was undone.
enum class DriftUndone {
  kNothing,  ///< it was not
  kRecipe,   ///< by the recipe's pixels per um
  kSlices,   ///< by what was measured in the slices themselves, in a first pass
};
inline constexpr std::array kAllDriftUndone{DriftUndone::kNothing, DriftUndone::kRecipe, DriftUndone::kSlices};

/// "nothing", "recipe", "slices".
[[nodiscard]] std::string_view drift_undone_name(DriftUndone undone) noexcept;
[[nodiscard]] std::optional<DriftUndone> drift_undone_from_name(std::string_view name) noexcept;

/// Heights of another peak method.
struct FurtherHeights {
  PeakMethod peak = PeakMethod::kParabola;
  std::optional<double> min_um;  ///< absent, as the others, where every point is a hole
  std::optional<double> max_um;
  std::optional<double> mean_um;
  std::optional<double> median_um;
  bool operator==(const FurtherHeights&) const = default;
};

/// A verdict does not wait for all files of its result.
enum class FileState {
  kWritten,  ///< it is there, durable
  kPending,  ///< it follows
  kNotMade,  ///< it could not be made
};
inline constexpr std::array kAllFileStates{FileState::kWritten, FileState::kPending, FileState::kNotMade};

/// "written", "pending", "not_made".
[[nodiscard]] std::string_view file_state_name(FileState state) noexcept;
[[nodiscard]] std::optional<FileState> file_state_from_name(std::string_view name) noexcept;

/// A file of the result, or all files of one folder of it.
struct ResultFile {
  std::string name;                         ///< the name of a folder ends with '/'
  std::optional<std::uint64_t> files = {};  ///< number of files in a folder
  std::uint64_t size_bytes = 0;             ///< of one that is written
  FileState state = FileState::kWritten;
  std::string sha256 = {};  ///< of its bytes as they were written; empty = not known yet, or a folder
  std::string reason = {};  ///< why it could not be made
  bool operator==(const ResultFile&) const = default;
};

/// Of the part, or of the room where the part's is not measured.
struct Temperature {
  double celsius = 20.0;
  std::string source;  ///< "job", or the file that it was read from
  double age_s = 0.0;  ///< when the scan began
  bool operator==(const Temperature&) const = default;
};

struct Result {
  static constexpr int kFormat = 2;  ///< of result.json and of mask.png beside it

  struct Job {
    std::string id;                   ///< empty = no job, as of recorded slices
    std::optional<std::int64_t> seq;  ///< absent likewise
    std::string part_id;
    bool operator==(const Job&) const = default;
  };
  struct Recipe {
    std::string id;      ///< empty = none
    std::string sha256;  ///< of its canonical JSON; empty = none
    bool operator==(const Recipe&) const = default;
  };
  struct Focus {
    int width_px = 0;
    int height_px = 0;
    std::optional<double> pixel_pitch_x_um;  ///< absent = unknown
    std::optional<double> pixel_pitch_y_um;
    FocusSettings settings;                          ///< all but stage_correction
    BinChoice bins_by = BinChoice::kUnknownWidth;    ///< why settings.bin_slices is what it is
    std::optional<double> smooth_px;                 ///< of the smoothed map; nothing = there is none
    double lateral_period_px = 0.0;                  ///< see lateral_period.hpp
    std::optional<double> smooth_lateral_period_px;  ///< of the smoothed map
    double noise_grey = 0.0;
    std::optional<double> curve_width_um;
    PeakMethod peak = PeakMethod::kParabola;
    std::vector<FurtherHeights> extra_peaks;
    double state_bytes_per_pixel = 0.0;
    std::optional<int> texture_max_grey = {};  ///< the brightest level that texture.png can hold; absent = not known
  };
  /// Of the slices as they came, in pixels: right and down.
  struct Drift {
    double x_px = 0.0;  ///< from the first slice to the last
    double y_px = 0.0;
    double x_px_per_um = 0.0;
    double y_px_per_um = 0.0;
    DriftUndone undone = DriftUndone::kNothing;
    bool operator==(const Drift&) const = default;
  };
  struct Slices {
    int planned = 0;
    int measured = 0;
    std::optional<double> first_um;  ///< commanded z of the first and the last slice that was taken
    std::optional<double> last_um;
    ScanMode mode = ScanMode::kStep;
    double speed_um_per_s = 0.0;               ///< continuous
    int ramp_frames = 0;                       ///< continuous
    std::vector<SuspectSlice> suspect;         ///< frames that must not be believed, and what was done about them
    int retaken = 0;                           ///< of those: another frame of the same height took their place
    std::optional<double> flicker_percent;     ///< of the light from slice to slice, corrected; absent in older results
    std::optional<Drift> drift = {};           ///< absent where the slices do not tell
    std::optional<double> scale_percent = {};  ///< growth of the image over the focus curve's width
    std::optional<double> exposure_us = {};    ///< of each slice; absent where the camera did not tell it
    bool operator==(const Slices&) const = default;
  };
  /// What the focus curves say of the stage.
  struct Stage {
    bool corrected = false;
    std::string reason;  ///< why not
    double offsets_rms_um = 0.0;
    double offset_error_um = 0.0;
    bool operator==(const Stage&) const = default;
  };
  /// Of heights that are the mean of several scans.
  struct Repeat {
    int scans = 0;
    std::optional<double> sd_rms_um;  ///< of single scans about the mean; absent without a valid point
    bool operator==(const Repeat&) const = default;
  };
  struct Provenance {
    std::string software_version;
    bool simulated = false;
    std::chrono::system_clock::time_point created;  ///< to 1 ms
    std::string source;                             ///< camera and stage, or the folder of recorded slices
    bool operator==(const Provenance&) const = default;
  };

  Job job;
  Recipe recipe;
  std::string objective;                   ///< that was confirmed; empty = none is named
  std::optional<Temperature> temperature;  ///< absent = not known
  std::optional<Calibration> calibration;  ///< that was in force for the objective; absent = none
  RepeatabilityMap repeatability;          ///< of the recipe's values, from its newest gauge study
  std::optional<Verdict> verdict;          ///< absent = nothing was judged; says nothing about how the job ended
  std::vector<MeasuredValue> measurements;
  std::optional<Evaluation> evaluation;  ///< where the recipe asks for one
  std::vector<Warning> warnings;
  std::size_t points = 0;
  std::size_t valid_points = 0;
  HoleCounts holes;
  Focus focus;
  FrameCounts frames;
  Slices slices;
  std::optional<Repeat> repeat = {};  ///< absent where there was one scan
  StepSummary steps;
  std::optional<double> encoder_resolution_um;  ///< smallest step of the measured positions; absent = not known
  Stage stage;
  PhaseTimes times;
  Provenance provenance;
  std::vector<ResultFile> files;  ///< all except result.json

  /// nullptr if there is none of that name.
  [[nodiscard]] const MeasuredValue* find(std::string_view name) const noexcept;
  [[nodiscard]] double valid_fraction() const noexcept;
};

}  // namespace fvd
