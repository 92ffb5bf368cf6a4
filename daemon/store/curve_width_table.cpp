#include "daemon/store/curve_width_table.hpp"

#include <algorithm>
#include <sstream>

namespace fvd {

namespace {

constexpr int kRememberedScans = 5;
constexpr double kNanometresPerUm = 1e3;  // the column holds whole ones

/// Everything that the width and the ends depend on: what a window sees of which part of the image, how finely and over
/// which range.
std::string settings_of(const Recipe& recipe) {
  const FocusSettings& focus = recipe.focus;
  const CameraSettings& camera = recipe.camera;
  std::ostringstream text;
  text << focus_operator_name(focus.focus_operator) << " distance " << focus.distance_px << ", "
       << focus_window_name(focus.window) << ' ' << focus.window_px << ", region " << camera.width << 'x'
       << camera.height << '+' << camera.offset_x << '+' << camera.offset_y << ", step " << recipe.step_um << " from "
       << recipe.start_um << ' ' << recipe.slices << " times"
       << (recipe.mode == ScanMode::kContinuous ? " in motion" : "");
  return text.str();
}

std::optional<LearntWidth> learnt_in(const Database& database, const Recipe& recipe) {
  Statement rows(database,
                 "SELECT width_nm, scans, most_bin_slices FROM curve_widths WHERE recipe = ? AND settings = ?");
  rows.bind(recipe.id).bind(settings_of(recipe));
  if (!rows.step()) return std::nullopt;
  return LearntWidth{static_cast<double>(rows.integer(0)) / kNanometresPerUm, static_cast<int>(rows.integer(1)),
                     static_cast<int>(rows.integer(2))};
}

}  // namespace

std::optional<LearntWidth> CurveWidthTable::find(const Recipe& recipe) const {
  const MutexLock lock(reader_.mutex);
  return learnt_in(reader_.database, recipe);
}

void CurveWidthTable::learn(const Recipe& recipe, double width_um, int most_bin_slices) {
  const MutexLock lock(writer_.mutex);
  Transaction transaction(writer_.database);
  const LearntWidth before = learnt_in(writer_.database, recipe).value_or(LearntWidth{});
  const int scans = std::min(before.scans + 1, kRememberedScans);
  const double mean_um = before.width_um + (width_um - before.width_um) / scans;
  Statement(writer_.database,
            "INSERT OR REPLACE INTO curve_widths (recipe, settings, width_nm, scans, most_bin_slices) "
            "VALUES (?, ?, ?, ?, ?)")
      .bind(recipe.id)
      .bind(settings_of(recipe))
      .bind(static_cast<std::int64_t>(mean_um * kNanometresPerUm + 0.5))
      .bind(std::int64_t{scans})
      .bind(std::int64_t{std::min(before.most_bin_slices, most_bin_slices)})
      .run();
  transaction.commit();
}

}  // namespace fvd
