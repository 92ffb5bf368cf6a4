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

LearntWidth learnt_width(std::int64_t width_nm, std::int64_t scans, std::int64_t most_bin_slices) {
  return {static_cast<double>(width_nm) / kNanometresPerUm, static_cast<int>(scans), static_cast<int>(most_bin_slices)};
}

std::optional<LearntWidth> learnt_in(const Database& database, const std::string& recipe, const std::string& settings) {
  Statement rows(database,
                 "SELECT width_nm, scans, most_bin_slices FROM curve_widths WHERE recipe = ? AND settings = ?");
  rows.bind(recipe).bind(settings);
  if (!rows.step()) return std::nullopt;
  return learnt_width(rows.integer(0), rows.integer(1), rows.integer(2));
}

}  // namespace

std::optional<LearntWidth> CurveWidthTable::find(const Recipe& recipe) const {
  const std::string settings = settings_of(recipe);
  // Held while the row is read: what is learnt meanwhile is remembered afterwards.
  const MutexLock lock(known_mutex_);
  const auto known = known_.find(recipe.id);
  if (known != known_.end() && known->second.settings == settings) return known->second.learnt;
  const MutexLock reading(reader_.mutex);
  const auto learnt = learnt_in(reader_.database, recipe.id, settings);
  known_[recipe.id] = {settings, learnt};
  return learnt;
}

void CurveWidthTable::learn(const Recipe& recipe, double width_um, int most_bin_slices) {
  const std::string settings = settings_of(recipe);
  const MutexLock lock(writer_.mutex);
  Transaction transaction(writer_.database);
  const LearntWidth before = learnt_in(writer_.database, recipe.id, settings).value_or(LearntWidth{});
  const int scans = std::min(before.scans + 1, kRememberedScans);
  const double mean_um = before.width_um + (width_um - before.width_um) / scans;
  const auto width_nm = static_cast<std::int64_t>(mean_um * kNanometresPerUm + 0.5);
  const int most = std::min(before.most_bin_slices, most_bin_slices);
  Statement(writer_.database,
            "INSERT OR REPLACE INTO curve_widths (recipe, settings, width_nm, scans, most_bin_slices) "
            "VALUES (?, ?, ?, ?, ?)")
      .bind(recipe.id)
      .bind(settings)
      .bind(width_nm)
      .bind(std::int64_t{scans})
      .bind(std::int64_t{most})
      .run();
  transaction.commit();
  const MutexLock remembering(known_mutex_);
  known_[recipe.id] = {settings, learnt_width(width_nm, scans, most)};
}

}  // namespace fvd
