#pragma once

/// A recipe: how one kind of part is measured.

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "core/focus/measure/focus_settings.hpp"
#include "core/hw/axis.hpp"
#include "core/hw/camera.hpp"
#include "core/scan/scan_plan.hpp"
#include "daemon/evaluation/evaluation_plan.hpp"

namespace fvd {

/// A focus curve's width that was measured, not given.
struct LearntWidth {
  double width_um = 0.0;                ///< full width at half maximum
  int scans = 0;                        ///< that told it; 0 = the slices themselves, which were looked at first
  int most_bin_slices = kMaxBinSlices;  ///< larger bins would have cost heights near the ends of the range
};

/// The report for people, beside the other files of a result.
struct ReportSettings {
  std::optional<bool> pdf;      ///< with or without report.pdf, whatever export says; absent = as export says
  std::string language = "en";  ///< the only one so far
};

struct Recipe {
  std::string id;  ///< file name without .json: [A-Za-z0-9_-]{1,32}
  std::string description;
  std::string sha256;              ///< of the document's bytes, in hex, as sha256sum tells it; stamped into results
  int format = 2;                  ///< 1 or 2, in which the document is written; places in messages are those of it
  std::vector<std::string> notes;  ///< what the author should know of an accepted document; not of the recipe itself

  std::string objective;  ///< that must be the confirmed one; empty = any

  double start_um = 0.0;  ///< z of the lowest slice
  double step_um = 10.0;  ///< > 0, distance of slices
  int slices = 21;        ///< 3..65535
  ScanMode mode = ScanMode::kStep;
  bool downwards = false;       ///< from the highest slice to the lowest; not of continuous scans
  double speed_um_per_s = 0.0;  ///< continuous: > 0
  double max_blur_steps = 0.5;  ///< continuous: > 0, way of the stage during an exposure
  int repeat = 1;               ///< 1..20 scans, of which the heights are the mean
  SettleCriterion settle;
  int frame_retries = 3;        ///< 0..100, further triggers for a slice whose frame was lost
  int allowed_lost_slices = 0;  ///< 0..slices - 3; more fail the job

  CameraSettings camera;
  double drift_px_per_um_x =
      0.0;  ///< -10..10, the image moves right by so much per um of z, and each slice is put back
  double drift_px_per_um_y = 0.0;  ///< and down
  FocusSettings focus;
  double curve_width_um = 0.0;              ///< full width at half maximum of the focus curve, 0 = unknown
  int bin_slices = 0;                       ///< slices summed to one sample of the curve; 0 = by the curve's width
  std::optional<LearntWidth> learnt_width;  ///< takes the place of a curve_width_um of 0; not of the document
  std::optional<double> smooth_px;          ///< kMinSmoothPx..kMaxSmoothPx: also a smoothed map; see smooth_heights.hpp
  PeakMethod peak = PeakMethod::kFiveSample;
  std::vector<PeakMethod> extra_peaks;  ///< further height maps from the same scan, height_<method>.tiff

  double pixel_pitch_x_um = 1.0;  ///< > 0, on the object
  double pixel_pitch_y_um = 1.0;
  double min_valid_fraction = 0.0;  ///< 0..1; fewer valid points fail the job
  /// Names of exporters whose files a result has beside result.json; nothing = all there are.
  std::optional<std::vector<std::string>> exports;
  EvaluationPlan evaluation;  ///< what is measured on the heights; empty = nothing
  ReportSettings report;
  bool keep_slices = false;  ///< also keep the slices (PGM) and their z in the result's folder slices/
};

/// Whether the bins follow from a width that the document does not tell.
[[nodiscard]] inline bool learns_bins(const Recipe& recipe) {
  return recipe.bin_slices == 0 && recipe.curve_width_um == 0.0;
}

/// The focus settings of a scan: recipe.focus with its bins chosen.
[[nodiscard]] inline FocusSettings focus_settings(const Recipe& recipe) {
  FocusSettings settings = recipe.focus;
  const double learnt_um = recipe.learnt_width ? recipe.learnt_width->width_um : 0.0;
  const double width_um = recipe.curve_width_um > 0.0 ? recipe.curve_width_um : learnt_um;
  settings.bin_slices =
      recipe.bin_slices > 0 ? recipe.bin_slices : choose_bin_slices(recipe.step_um, width_um, recipe.slices);
  if (learns_bins(recipe) && recipe.learnt_width) {
    settings.bin_slices = std::min(settings.bin_slices, recipe.learnt_width->most_bin_slices);
  }
  return settings;
}

}  // namespace fvd
