#include "daemon/recipes/recipe_book.hpp"

#include <algorithm>
#include <memory>
#include <sstream>

#include <glib.h>
#include <nlohmann/json.hpp>

#include "config/field_reader.hpp"
#include "config/field_writer.hpp"
#include "config/strict_json.hpp"
#include "core/base/error.hpp"

namespace fvd {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxIdLength = 32;
constexpr int kContinuousPoolFrames = 24;

std::string sha256(const std::string& bytes) {
  const std::unique_ptr<char, decltype(&g_free)> digest(
      g_compute_checksum_for_data(G_CHECKSUM_SHA256, reinterpret_cast<const guchar*>(bytes.data()), bytes.size()),
      &g_free);
  return digest.get();
}

/// Every value in force with sorted keys: comments, layout and spelled-out defaults do not change the digest.
std::string canonical_text(Recipe recipe) {
  const nlohmann::json sorted = fields_to_json([&](Fields& fields) { describe(recipe, fields); });
  return sorted.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
}

void check_together(const Recipe& recipe, Problems& problems) {
  const auto refuse = [&](const char* pointer, auto value, const std::string& why) {
    std::ostringstream text;
    text << value << " " << why;
    problems.push_back({pointer, text.str()});
  };
  if (recipe.focus.window_px % 2 == 0) {
    refuse("/focus/window_px", recipe.focus.window_px, "is even; expected an odd number so that a pixel is its centre");
  }
  if (recipe.allowed_lost_slices > recipe.slices - 3) {
    refuse("/scan/allowed_lost_slices", recipe.allowed_lost_slices,
           "leaves fewer than 3 slices; expected at most " + std::to_string(recipe.slices - 3));
  }
  if (recipe.mode == ScanMode::kContinuous && recipe.camera.trigger == TriggerMode::kLine) {
    refuse("/scan/trigger", "line", "is for scan.mode step; in a continuous scan the camera runs free");
  }
  if (std::find(recipe.extra_peaks.begin(), recipe.extra_peaks.end(), recipe.peak) != recipe.extra_peaks.end()) {
    refuse("/focus/extra_peaks", peak_method_name(recipe.peak), "is the peak already; expected others only");
  }
}

std::string known_recipes(const fs::path& folder) {
  std::string text;
  for (const std::string& id : list_recipes(folder)) text += (text.empty() ? "" : ", ") + id;
  return text.empty() ? "there are none" : "known are " + text;
}

}  // namespace

bool is_recipe_id(std::string_view id) noexcept {
  const auto allowed = [](char c) {
    return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  };
  return !id.empty() && id.size() <= kMaxIdLength && std::all_of(id.begin(), id.end(), allowed);
}

std::vector<std::string> list_recipes(const fs::path& folder) {
  std::vector<std::string> ids;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    std::error_code ignored;
    const std::string id = entry->path().stem().string();
    if (entry->path().extension() == ".json" && is_recipe_id(id) && entry->is_regular_file(ignored)) ids.push_back(id);
  }
  if (error) throw Error(ErrorCode::kBadInput, "cannot list recipes in " + folder.string() + ": " + error.message());
  std::sort(ids.begin(), ids.end());
  return ids;
}

std::string recipe_text(const fs::path& folder, const std::string& id) {
  if (!is_recipe_id(id)) {
    throw Error(ErrorCode::kUnknownRecipe, "a recipe id has 1 to 32 of the characters A-Z a-z 0-9 _ -");
  }
  const fs::path file = folder / (id + ".json");
  std::error_code error;
  if (!fs::exists(file, error)) {
    throw Error(ErrorCode::kUnknownRecipe, "there is no recipe '" + id + "'; " + known_recipes(folder));
  }
  return read_text_file(file);
}

Recipe load_recipe(const fs::path& folder, const std::string& id) { return parse_recipe(recipe_text(folder, id), id); }

Recipe parse_recipe(std::string_view json_text, const std::string& id) {
  Recipe recipe;
  Problems problems;
  read_document(
      json_text, [&](Fields& fields) { describe(recipe, fields); }, problems);
  if (problems.empty()) check_together(recipe, problems);
  throw_if_any(problems, ErrorCode::kBadRecipe, "recipe " + id);
  // Frames wait for their position, and for those before them to be complete, while the camera goes on.
  if (recipe.mode == ScanMode::kContinuous) recipe.camera.pool_frames = kContinuousPoolFrames;
  recipe.id = id;
  recipe.sha256 = sha256(canonical_text(recipe));
  return recipe;
}

Problems check_stage_limits(const Recipe& recipe, Micrometers min, Micrometers max, Micrometers take_up) {
  Problems problems;
  const double first = recipe.start_um - take_up.value;
  const double last = recipe.start_um + recipe.step_um * (recipe.slices - 1);
  if (first < min.value) {
    std::ostringstream text;
    text << recipe.start_um << " with " << take_up.value << " um of take-up reaches " << first
         << " um; expected a start of at least " << min.value + take_up.value << " um";
    problems.push_back({"/scan/start_um", text.str()});
  }
  if (last > max.value) {
    std::ostringstream text;
    text << recipe.slices << " slices reach " << last << " um; expected at most " << max.value
         << " um: fewer slices, a smaller step_um or a lower start_um";
    problems.push_back({"/scan/slices", text.str()});
  }
  return problems;
}

std::string recipe_schema_text() {
  Recipe defaults;
  return fields_to_schema([&](Fields& fields) { describe(defaults, fields); }, "fvd recipe").dump(2) + "\n";
}

}  // namespace fvd
