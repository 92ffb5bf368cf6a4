#include "daemon/pipeline/reconstruct.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <limits>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "core/focus/fit/smooth_heights.hpp"
#include "daemon/evaluation/evaluate_surface.hpp"
#include "daemon/export/exporter_table.hpp"
#include "daemon/pipeline/evaluation_input.hpp"

namespace fvd {

namespace {

constexpr double kUsualJump = 3.0;  ///< steps

HeightMap finish(const StreamingFocusStack& stack, PeakMethod method, const ResultData& data) {
  HeightMap map = stack.finish(method);
  hide_border(map, data.hidden_border, data.focus.window_px / 2 + data.focus.distance_px);
  return map;
}

/// The files that the recipe asks for, with its report or without it as its section "report" says.
std::optional<std::vector<std::string>> files_of(const Recipe& recipe) {
  constexpr std::string_view kReport = "report.pdf";
  if (!recipe.report.pdf) return recipe.exports;
  std::vector<std::string> names;
  if (recipe.exports) {
    names = *recipe.exports;
  } else {
    for (const Exporter& exporter : chosen_exporters(std::nullopt)) names.emplace_back(exporter.name);
  }
  std::erase(names, kReport);
  if (*recipe.report.pdf) names.emplace_back(kReport);
  return names;
}

}  // namespace

BinChoice bin_choice(const Recipe& recipe) {
  if (!learns_bins(recipe)) return BinChoice::kRecipe;
  if (!recipe.learnt_width) return BinChoice::kUnknownWidth;
  return recipe.learnt_width->scans > 0 ? BinChoice::kEarlierScans : BinChoice::kSlices;
}

void note_recipe(const Recipe& recipe, ResultData& data) {
  data.recipe_id = recipe.id;
  data.recipe_sha256 = recipe.sha256;
  data.focus = focus_settings(recipe);
  data.bins_by = bin_choice(recipe);
  data.peak = recipe.peak;
  data.pixel_pitch_x_um = recipe.pixel_pitch_x_um;
  data.pixel_pitch_y_um = recipe.pixel_pitch_y_um;
  if (recipe.drift_px_per_um_x != 0.0 || recipe.drift_px_per_um_y != 0.0) {
    data.drift_undone = DriftUndone::kRecipe;
    data.drift_undone_x_px_per_um = recipe.drift_px_per_um_x;
    data.drift_undone_y_px_per_um = recipe.drift_px_per_um_y;
  }
  data.min_valid_fraction = recipe.min_valid_fraction;
  data.exports = files_of(recipe);
}

void note_light(const std::vector<SuspectSlice>& left_out, double flicker_percent, ResultData& data) {
  data.suspects.insert(data.suspects.end(), left_out.begin(), left_out.end());
  std::stable_sort(data.suspects.begin(), data.suspects.end(),
                   [](const SuspectSlice& a, const SuspectSlice& b) { return a.index < b.index; });
  data.flicker_percent = flicker_percent;
}

void note_drift(const DriftMeter& drift, const HiddenBorder& hidden, ResultData& data) {
  data.drift = drift.figures();
  data.hidden_border = hidden;
}

DriftPath recipe_drift(const Recipe& recipe, double middle_um) {
  if (recipe.drift_px_per_um_x == 0.0 && recipe.drift_px_per_um_y == 0.0) return {};
  return {recipe.drift_px_per_um_x, recipe.drift_px_per_um_y, middle_um};
}

int most_bin_slices(const Plane<float>& height_m, const StepLog& steps, double step_um) {
  constexpr double kLostShare = 0.005;
  constexpr double kUncertain = 0.25;  // steps: where a peak that lies there is seen
  double lowest_um = std::numeric_limits<double>::infinity();
  double highest_um = -lowest_um;
  for (const StepRecord& step : steps) {
    if (!step.measured) continue;
    lowest_um = std::min(lowest_um, step.measured_um);
    highest_um = std::max(highest_um, step.measured_um);
  }
  std::array<std::size_t, kMaxBinSlices + 1> kept_up_to{};  // points that larger bins than so many slices lose
  std::size_t points = 0;
  for (const float height : height_m.pixels()) {
    if (std::isnan(height)) continue;
    ++points;
    const double height_um = 1e6 * static_cast<double>(height);
    const double margin = std::min(height_um - lowest_um, highest_um - height_um) / step_um;
    const double most = std::clamp(std::floor(margin + 0.5 - kUncertain), 1.0, static_cast<double>(kMaxBinSlices));
    ++kept_up_to[static_cast<std::size_t>(most)];
  }
  std::size_t lost = 0;
  for (int bin = 1; bin < kMaxBinSlices; ++bin) {
    lost += kept_up_to[static_cast<std::size_t>(bin)];
    if (static_cast<double>(lost) > kLostShare * static_cast<double>(points)) return bin;
  }
  return kMaxBinSlices;
}

void reconstruct(const StreamingFocusStack& stack, const Recipe& recipe, ResultData& data) {
  data.state_bytes_per_pixel = stack.state_bytes_per_pixel();
  data.map = finish(stack, recipe.peak, data);
  const int wanted = std::min(choose_bin_slices(recipe.step_um, data.map.curve_width_um, recipe.slices),
                              most_bin_slices(data.map.height_m, data.steps, recipe.step_um));
  if (data.bins_by != BinChoice::kUnknownWidth || wanted == data.focus.bin_slices) return;
  std::ostringstream text;
  text.precision(3);
  text << "the step of " << recipe.step_um << " um is " << recipe.step_um / data.map.curve_width_um
       << " of the focus curve's width of " << data.map.curve_width_um << " um, which nothing had told before: bins of "
       << wanted << " slices would make less error; the next scan of the recipe has them, or say curve_width_um";
  data.warnings.push_back({"bins_unknown", text.str()});
}

void evaluate_as_asked(const Recipe& recipe, WorkerPool& pool, ResultData& data, const KeptPagesPtr& pages) {
  if (recipe.evaluation.empty()) return;
  const auto start = std::chrono::steady_clock::now();
  data.evaluation =
      evaluate_surface(surface_to_evaluate(data), recipe.evaluation, evaluation_context(data), &pool, pages);
  data.times.evaluate_ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

void reconstruct_further(const StreamingFocusStack& stack, const Recipe& recipe, WorkerPool& pool, ResultData& data) {
  if (recipe.smooth_px) {
    data.smooth_px = recipe.smooth_px;
    // Within a curve's width noise alone may part neighbours.
    const double jump_um = data.map.curve_width_um > 0.0 ? data.map.curve_width_um : kUsualJump * recipe.step_um;
    data.smoothed = smooth_heights(data.map.height_m, data.map.sigma_m,
                                   {*recipe.smooth_px, window_area_px2(data.focus), jump_um}, pool);
  }
  for (const PeakMethod method : recipe.extra_peaks) {
    const bool done = method == recipe.peak || std::any_of(data.extra_maps.begin(), data.extra_maps.end(),
                                                           [method](const auto& map) { return map.first == method; });
    if (!done) data.extra_maps.emplace_back(method, finish(stack, method, data));
  }
}

}  // namespace fvd
