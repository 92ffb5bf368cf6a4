#include "daemon/pipeline/reconstruct.hpp"

#include <algorithm>
#include <sstream>

#include "core/focus/fit/smooth_heights.hpp"

namespace fvd {

namespace {

constexpr double kUsualJump = 3.0;  ///< steps

HeightMap finish(const StreamingFocusStack& stack, PeakMethod method, const ResultData& data) {
  HeightMap map = stack.finish(method);
  hide_border(map, data.hidden_border, data.focus.window_px / 2 + data.focus.distance_px);
  return map;
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
  data.exports = recipe.exports;
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

void reconstruct(const StreamingFocusStack& stack, const Recipe& recipe, ResultData& data) {
  data.state_bytes_per_pixel = stack.state_bytes_per_pixel();
  data.map = finish(stack, recipe.peak, data);
  const int wanted = choose_bin_slices(recipe.step_um, data.map.curve_width_um, recipe.slices);
  if (data.bins_by != BinChoice::kUnknownWidth || wanted == data.focus.bin_slices) return;
  std::ostringstream text;
  text.precision(3);
  text << "the step of " << recipe.step_um << " um is " << recipe.step_um / data.map.curve_width_um
       << " of the focus curve's width of " << data.map.curve_width_um << " um, which nothing had told before: bins of "
       << wanted << " slices would make less error; the next scan of the recipe has them, or say curve_width_um";
  data.warnings.push_back({"bins_unknown", text.str()});
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
