#include "daemon/result/evaluate.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <utility>

#include "core/focus/lateral_period.hpp"

namespace fvd {

namespace {

constexpr const char* kValidFraction = "valid_fraction";
/// Share of the points that are sharpest at one end of the scan, above which the result warns: the surface may reach
/// beyond that end.
constexpr double kMaxFractionAtEnd = 0.05;
/// Flicker of the light above which the result warns.
constexpr double kMaxFlicker_percent = 2.0;
constexpr int kListedSuspects = 4;
/// Over the focus curve's width, above which the result warns.
constexpr double kMaxDrift_px = 1.0;
constexpr double kMaxScale_percent = 0.2;
/// So many standard errors a change of scale lies above its limit before it is said.
constexpr double kErrors = 2.0;
/// So many times its standard error a drift must be: less may be noise.
constexpr double kLeastDriftErrors = 3.0;
/// Share of valid points below which the result warns.
constexpr double kFewValid = 0.05;

FurtherHeights further_heights(PeakMethod peak, const HeightMap& map) {
  const auto height = summarize_heights(map.height_m, map.sigma_m, map.mask).height;
  if (!height) return {peak, {}, {}, {}, {}};
  return {peak, height->min_um, height->max_um, height->mean_um, height->median_um};
}

Result::Focus focus_of(const ResultData& data) {
  Result::Focus focus;
  focus.width_px = data.map.height_m.width();
  focus.height_px = data.map.height_m.height();
  focus.pixel_pitch_x_um = data.pixel_pitch_x_um;
  focus.pixel_pitch_y_um = data.pixel_pitch_y_um;
  focus.settings = data.focus;
  focus.bins_by = data.bins_by;
  focus.smooth_px = data.smooth_px;
  focus.lateral_period_px = lateral_period_px(data.focus, {});
  if (data.smooth_px) focus.smooth_lateral_period_px = lateral_period_px(data.focus, data.smooth_px);
  focus.noise_grey = data.map.noise_grey;
  if (data.map.curve_width_um > 0.0) focus.curve_width_um = data.map.curve_width_um;
  focus.peak = data.peak;
  for (const auto& [method, map] : data.extra_maps) focus.extra_peaks.push_back(further_heights(method, map));
  focus.state_bytes_per_pixel = data.state_bytes_per_pixel;
  focus.texture_max_grey = max_grey_level(data.map.texture_format);
  return focus;
}

bool was_taken_again(const SuspectSlice& slice) { return slice.done == SuspectDone::kTakenAgain; }

Result::Slices slices_of(const ResultData& data) {
  Result::Slices slices;
  slices.planned = data.slices_planned;
  slices.measured = data.slices_measured_before;
  for (const StepRecord& step : data.steps) slices.measured += step.measured ? 1 : 0;
  if (!data.steps.empty()) {
    slices.first_um = data.steps.front().commanded_um;
    slices.last_um = data.steps.back().commanded_um;
  }
  slices.exposure_us = data.exposure_us;
  slices.mode = data.scan_mode;
  slices.speed_um_per_s = data.speed_um_per_s;
  slices.ramp_frames = data.ramp_frames;
  slices.suspect = data.suspects_before;
  slices.suspect.insert(slices.suspect.end(), data.suspects.begin(), data.suspects.end());
  slices.retaken = static_cast<int>(std::count_if(slices.suspect.begin(), slices.suspect.end(), was_taken_again));
  slices.flicker_percent = data.flicker_percent;
  if (!data.drift) return slices;
  const DriftFigures& drift = *data.drift;
  slices.drift = Result::Drift{drift.x_px, drift.y_px, drift.x_px_per_um, drift.y_px_per_um, data.drift_undone};
  if (drift.scale_per_um && data.map.curve_width_um > 0.0) {
    slices.scale_percent = 100.0 * *drift.scale_per_um * data.map.curve_width_um;
  }
  return slices;
}

std::vector<MeasuredValue> measurements_of(const ResultData& data, const HeightSummary& summary) {
  std::vector<MeasuredValue> all;
  const auto add = [&](const char* name, const char* kind, const char* unit, std::optional<double> value) {
    MeasuredValue measured;
    measured.name = name;
    measured.kind = kind;
    measured.unit = unit;
    measured.value = value;
    measured.points = summary.valid;
    measured.valid_fraction = summary.valid_fraction();
    all.push_back(std::move(measured));
  };
  const auto height = [&summary](double HeightValues::*of) {
    return summary.height ? std::optional(*summary.height.*of) : std::nullopt;
  };
  add("height_min", "height", "um", height(&HeightValues::min_um));
  add("height_max", "height", "um", height(&HeightValues::max_um));
  add("height_mean", "height", "um", height(&HeightValues::mean_um));
  add("height_median", "height", "um", height(&HeightValues::median_um));
  add("sigma_median", "sigma", "um", summary.sigma_median_um);
  add(kValidFraction, "fraction", "1", summary.valid_fraction());
  if (data.min_valid_fraction > 0.0) {
    MeasuredValue& valid = all.back();
    valid.points = summary.points;  // it rests on all of them
    valid.valid_fraction = 1.0;
    valid.limits = Limits{data.min_valid_fraction, std::nullopt};
    valid.verdict = judge(valid.value, *valid.limits);
  }
  return all;
}

void warn_of_suspects(const Result::Slices& slices, std::vector<Warning>& warnings) {
  const auto list = [&](bool again, const char* code, const char* what) {
    std::ostringstream text;
    int count = 0;
    for (const SuspectSlice& slice : slices.suspect) {
      if (was_taken_again(slice) != again) continue;
      if (++count <= kListedSuspects) text << (count > 1 ? "; " : "") << suspect_text(slice);
    }
    if (count == 0) return;
    if (count > kListedSuspects) text << "; and " << count - kListedSuspects << " more, see slices.suspect";
    warnings.push_back({code, std::to_string(count) + " slice(s) " + what + ": " + text.str()});
  };
  list(false, "slices_left_out", "left out");
  list(true, "slices_retaken", "taken again");
  if (slices.flicker_percent.value_or(0.0) <= kMaxFlicker_percent) return;
  std::ostringstream text;
  text.precision(2);
  text << "the light varies by " << *slices.flicker_percent
       << " % from slice to slice; sharpness was corrected for it: check lamp, flash and exposure";
  warnings.push_back({"light_flicker", text.str()});
}

/// Of what is left after undoing, unless its own error can make as much.
void warn_of_drift(const ResultData& data, std::vector<Warning>& warnings) {
  if (!data.drift || data.drift_undone == DriftUndone::kSlices) return;
  const DriftFigures& drift = *data.drift;
  const double width_um = data.map.curve_width_um;
  const double left_px = width_um * std::hypot(drift.x_px_per_um - data.drift_undone_x_px_per_um,
                                               drift.y_px_per_um - data.drift_undone_y_px_per_um);
  if (left_px > std::max(kMaxDrift_px, kLeastDriftErrors * width_um * drift.error_px_per_um)) {
    std::ostringstream text;
    text.precision(3);
    text << "the image drifts by " << left_px << " px over the focus curve's width of " << width_um
         << " um: heights are less certain, and wrong beside edges and on slopes; measured are " << drift.x_px_per_um
         << " px/um to the right and " << drift.y_px_per_um
         << " px/um down: put them into acquire.camera.drift_px_per_um_x and _y, or process recorded slices with "
            "--drift auto";
    warnings.push_back({"lateral_drift", text.str()});
  }
}

void warn_of_scale(const ResultData& data, std::vector<Warning>& warnings) {
  if (!data.drift || !data.drift->scale_per_um) return;
  const double width_um = data.map.curve_width_um;
  const double scale_percent = 100.0 * width_um * *data.drift->scale_per_um;
  const double error_percent = 100.0 * width_um * data.drift->scale_error_per_um;
  if (std::abs(scale_percent) - kErrors * error_percent <= kMaxScale_percent) return;
  std::ostringstream text;
  text.precision(2);
  text << "the image " << (scale_percent > 0.0 ? "grows" : "shrinks") << " by " << std::abs(scale_percent)
       << " % over the focus curve's width of " << width_um
       << " um, which is not corrected: far from the middle of the image heights are less certain; a telecentric lens "
          "does not do that";
  warnings.push_back({"scale_changes", text.str()});
}

/// What most holes are, and what could be done about it.
std::string most_holes_text(const HoleCounts& holes) {
  struct Reason {
    std::size_t points;
    const char* text;
  };
  const std::array reasons{
      Reason{holes.low_prominence,
             "have too flat a focus curve (min_prominence): is the light on, and the surface within the range?"},
      Reason{holes.first_slice, "are sharpest at the first slice: does the surface lie beyond the range?"},
      Reason{holes.last_slice, "are sharpest at the last slice: does the surface lie beyond the range?"},
      Reason{holes.not_bracketed, "have a peak that its neighbours do not enclose: take slices closer together"},
      Reason{holes.saturated, "are at full scale (clipped_share): less exposure or light"},
      Reason{holes.insignificant,
             "rise too little above the noise (min_significance): is the light on, and the surface within the range?"},
      Reason{holes.edge_bleeding, "show the blur of brighter edges: less contrast of the light"},
      Reason{holes.broad_curve, "have a far broader focus curve than the others (broad_curve)"},
      Reason{holes.narrow_curve, "have a far narrower focus curve than the others (narrow_curve)"},
      Reason{holes.second_peak, "have a second peak (second_peak)"},
      Reason{holes.edge_band, "lie beside a jump of the heights (edge_band_slices)"},
      Reason{holes.max_sigma, "have a larger standard error than allowed (max_sigma_um)"},
      Reason{holes.out_of_view, "are not in every slice, as the image drifts"}};
  const auto& most = *std::max_element(reasons.begin(), reasons.end(),
                                       [](const Reason& a, const Reason& b) { return a.points < b.points; });
  return most.points == 0 ? std::string() : "; " + std::to_string(most.points) + " points " + most.text;
}

void warn_of_holes(const Result& result, std::vector<Warning>& warnings) {
  const std::string most = most_holes_text(result.holes);
  if (result.valid_points == 0) {
    warnings.push_back({"no_valid_point", "not one point is valid" + most});
  } else if (result.valid_fraction() < kFewValid) {
    std::ostringstream text;
    text.precision(2);
    text << "only " << 100.0 * result.valid_fraction() << " % of the points are valid" << most;
    warnings.push_back({"few_valid_points", text.str()});
  }
}

void warn_of_lapsed(const ResultData& data, std::vector<Warning>& warnings) {
  if (!data.calibration) return;
  const std::string parts = lapsed_text(*data.calibration, calendar_day(data.created));
  if (parts.empty()) return;
  warnings.push_back({"calibration_lapsed", "constants of the calibration " + data.calibration->id +
                                                " are past the day that they were to be renewed by: " + parts +
                                                "; values and U still rest on them: calibrate again"});
}

std::vector<Warning> warnings_of(const Result& result, const ResultData& data) {
  std::vector<Warning> warnings = data.warnings;
  const int missing = result.slices.planned - result.slices.measured;
  if (missing > 0) {
    warnings.push_back({"slices_missing", std::to_string(missing) + " of " + std::to_string(result.slices.planned) +
                                              " slices are missing; heights near them are less certain"});
  } else if (missing < 0) {
    warnings.push_back({"slices_added", std::to_string(-missing) + " slices more than the " +
                                            std::to_string(result.slices.planned) +
                                            " that were planned cover the range: the camera is faster than asked"});
  }
  warn_of_lapsed(data, warnings);
  warn_of_suspects(result.slices, warnings);
  warn_of_drift(data, warnings);
  warn_of_scale(data, warnings);
  warn_of_holes(result, warnings);
  const auto at_end = [&](std::size_t points, const char* code, const char* end) {
    const double fraction = result.points == 0 ? 0.0 : static_cast<double>(points) / static_cast<double>(result.points);
    if (fraction <= kMaxFractionAtEnd) return;
    std::ostringstream text;
    text.precision(3);
    text << 100.0 * fraction << " % of the points are sharpest at the " << end
         << " slice: the surface may reach beyond the range of the scan";
    warnings.push_back({code, text.str()});
  };
  at_end(result.holes.first_slice, "range_first", "first");
  at_end(result.holes.last_slice, "range_last", "last");
  return warnings;
}

}  // namespace

std::optional<Verdict> verdict_of(const Result& result) {
  std::vector<Verdict> verdicts;
  for (const MeasuredValue& value : result.measurements) {
    if (value.verdict) verdicts.push_back(*value.verdict);
  }
  const std::optional<Verdict> of_map = joined_verdict(verdicts);
  if (!result.evaluation || !result.evaluation->verdict) return of_map;
  if (!of_map) return result.evaluation->verdict;
  return worst_verdict(std::vector{*of_map, *result.evaluation->verdict});
}

Result evaluate(const ResultData& data, const HeightSummary& summary) {
  Result result;
  result.job = {data.job_id, data.seq, data.part_id};
  result.recipe = {data.recipe_id, data.recipe_sha256};
  result.objective = data.objective;
  result.temperature = data.temperature;
  result.calibration = data.calibration;
  result.repeatability = data.repeatability;
  result.points = summary.points;
  result.valid_points = summary.valid;
  result.holes = summary.holes;
  result.focus = focus_of(data);
  result.frames = data.frames;
  result.slices = slices_of(data);
  if (data.repeated) result.repeat = Result::Repeat{data.repeated->scans, data.repeated->sd_rms_um};
  result.steps = data.step_summary;
  result.encoder_resolution_um = data.encoder_resolution_um;
  result.stage = {data.map.stage.applied, data.map.stage.reason, data.map.stage.rms_um,
                  data.map.stage.standard_error_um};
  result.times = data.times;
  result.provenance = {data.software_version, data.simulated, data.created, data.source};
  result.measurements = measurements_of(data, summary);
  result.evaluation = data.evaluation;
  result.verdict = verdict_of(result);
  result.warnings = warnings_of(result, data);
  return result;
}

std::optional<Shortfall> shortfall(const Result& result) {
  const MeasuredValue* const valid = result.find(kValidFraction);
  if (valid == nullptr || !valid->limits || valid->verdict == Verdict::kPass) return std::nullopt;
  std::ostringstream message;
  message << "only " << 100.0 * result.valid_fraction() << " % of the points are valid, the recipe asks for "
          << 100.0 * valid->limits->lower.value_or(0.0) << " %; ";
  if (result.holes.first_slice + result.holes.last_slice > (result.points - result.valid_points) / 2) {
    message << "most of the others are sharpest at an end of the scan: move or widen the range of "
            << result.slices.first_um.value_or(0.0) << ".." << result.slices.last_um.value_or(0.0) << " um";
    return Shortfall{ErrorCode::kFocusRange, message.str()};
  }
  message << "most of the others have too little texture or are saturated: check light and exposure";
  return Shortfall{ErrorCode::kTooFewValid, message.str()};
}

}  // namespace fvd
