#pragma once

/// What was acquired for a result: its pixels, and what was noted on the way.

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/focus/drift_undo.hpp"
#include "core/focus/fit/height_map.hpp"
#include "core/focus/fit/smooth_heights.hpp"
#include "core/focus/judge/suspect_slice.hpp"
#include "core/focus/measure/focus_settings.hpp"
#include "core/metrology/height_field.hpp"
#include "core/scan/frame_ledger.hpp"
#include "core/scan/scan_plan.hpp"
#include "core/stage/stage_accuracy.hpp"
#include "core/stage/step_log.hpp"
#include "daemon/result/evaluation_result.hpp"
#include "daemon/result/repeatability.hpp"
#include "daemon/result/repeated_scans.hpp"
#include "daemon/result/result.hpp"

namespace fvd {

struct ResultData {
  std::string software_version;
  std::chrono::system_clock::time_point created;
  bool simulated = false;

  std::string job_id;
  std::optional<std::int64_t> seq;  ///< absent for offline processing
  std::string part_id;
  std::string recipe_id;
  std::string recipe_sha256;
  std::string source;  ///< camera and stage, or the folder of recorded slices

  std::string objective;                   ///< that was confirmed; empty = none is named
  std::optional<Temperature> temperature;  ///< absent = not known
  std::optional<Calibration> calibration;  ///< in force for the objective; absent = none
  RepeatabilityMap repeatability;          ///< of the recipe's values, from its newest gauge study
  /// The map that the calibration names, where the recipe asks for it; null = not at hand.
  std::shared_ptr<const metrology::HeightField> flatness_reference;

  FocusSettings focus;
  PeakMethod peak = PeakMethod::kParabola;
  std::optional<double> pixel_pitch_x_um;  ///< absent = unknown: files then carry pixels
  std::optional<double> pixel_pitch_y_um;
  BinChoice bins_by = BinChoice::kUnknownWidth;
  double min_valid_fraction = 0.0;                  ///< that the recipe asks for; 0 = it does not judge
  std::optional<std::vector<std::string>> exports;  ///< files that the recipe asks for, by name; absent = all
  double state_bytes_per_pixel = 0.0;

  HeightMap map;
  std::vector<std::pair<PeakMethod, HeightMap>> extra_maps;
  std::optional<double> smooth_px;
  std::optional<SmoothedHeights> smoothed;  ///< of `map`, where smooth_px is given
  std::optional<RepeatedScans> repeated;    ///< where `map` is the mean of several scans

  ScanMode scan_mode = ScanMode::kStep;
  double speed_um_per_s = 0.0;                ///< of a continuous scan
  int ramp_frames = 0;                        ///< likewise
  int slices_planned = 0;                     ///< of all scans
  std::optional<double> exposure_us;          ///< of each slice; absent = not known
  int slices_measured_before = 0;             ///< by the scans before the one of `steps`
  std::vector<SuspectSlice> suspects_before;  ///< of those scans, one scan after the other
  FrameCounts frames;                         ///< of all scans
  StepLog steps;                              ///< of the last scan
  StepSummary step_summary;
  std::optional<double> encoder_resolution_um;  ///< smallest step of the measured positions; absent = not known
  std::vector<SuspectSlice> suspects;           ///< in the order of the scan
  double flicker_percent = 0.0;                 ///< see SliceJudge
  std::optional<DriftFigures> drift;            ///< of the slices as they came
  DriftUndone drift_undone = DriftUndone::kNothing;
  double drift_undone_x_px_per_um = 0.0;  ///< kRecipe: what was undone
  double drift_undone_y_px_per_um = 0.0;
  HiddenBorder hidden_border;  ///< by undoing the drift
  PhaseTimes times;
  std::optional<Evaluation> evaluation;  ///< where the recipe asks for one
  std::vector<Warning> warnings;         ///< noted on the way; evaluation adds its own
};

}  // namespace fvd
