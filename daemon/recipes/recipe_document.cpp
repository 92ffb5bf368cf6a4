#include "daemon/recipes/recipe_document.hpp"

#include <algorithm>
#include <initializer_list>
#include <memory>
#include <sstream>

#include <glib.h>
#include <nlohmann/json.hpp>

#include "config/field_reader.hpp"
#include "config/strict_json.hpp"
#include "core/base/error.hpp"
#include "daemon/evaluation/check_plan.hpp"
#include "daemon/export/exporter_table.hpp"

namespace fvd {

namespace {

constexpr std::size_t kMaxIdLength = 32;
constexpr int kContinuousPoolFrames = 27;

/// A document without "format" that has a key which only format 1 has at its top.
bool is_format_1(const nlohmann::json& document) {
  if (!document.is_object() || document.contains("format")) return false;
  const auto keys = {"scan", "camera", "focus", "lateral", "result"};
  return std::any_of(keys.begin(), keys.end(), [&](const char* key) { return document.contains(key); });
}

/// Where the groups of a document stand.
struct Places {
  std::string scan;
  std::string focus;
};
const Places kFormat1Places{"/scan", "/focus"};
const Places kFormat2Places{"/acquire/scan", "/reconstruct/focus"};

std::string names_of_single_files() {
  std::string names;
  for (const Exporter& exporter : exporter_table()) {
    if (exporter.need == ExportNeed::kResult) names += (names.empty() ? "" : ", ") + std::string(exporter.name);
  }
  return names;
}

/// The names of the measurements as the document has them: objects that were read have lost the order of their keys.
std::vector<std::string> measurement_order(std::string_view json_text) {
  const auto document = nlohmann::ordered_json::parse(json_text, nullptr, false, true);
  const nlohmann::ordered_json::json_pointer place("/evaluation/measurements");
  std::vector<std::string> names;
  if (document.is_discarded() || !document.contains(place) || !document.at(place).is_object()) return names;
  for (const auto& [name, measurement] : document.at(place).items()) names.push_back(name);
  return names;
}

/// A default of 1 um would turn pixels into micrometres that nobody said.
void require_pitch(const Recipe& recipe, const nlohmann::json& document, Problems& problems) {
  if (recipe.evaluation.empty()) return;
  for (const char* key : {"/reconstruct/lateral/pixel_pitch_x_um", "/reconstruct/lateral/pixel_pitch_y_um"}) {
    if (document.contains(nlohmann::json::json_pointer(key))) continue;
    problems.push_back({key, "is missing; an evaluation needs the distance of the pixels on the object"});
  }
}

/// What keys say together; a rule is passed over where a value that it rests on was refused.
void check_together(const Recipe& recipe, const Places& places, Problems& problems) {
  const auto judged = [read = problems](std::initializer_list<std::string> pointers) {
    return std::none_of(pointers.begin(), pointers.end(),
                        [&read](const std::string& pointer) { return is_reported(read, pointer); });
  };
  const auto refuse = [&](const std::string& pointer, auto value, const std::string& why) {
    std::ostringstream text;
    text << value << " " << why;
    problems.push_back({pointer, text.str()});
  };
  const std::string window = places.focus + "/window_px";
  const std::string mode = places.scan + "/mode";
  const std::string trigger = places.scan + "/trigger";
  const std::string peak = places.focus + "/peak";
  const std::string extra_peaks = places.focus + "/extra_peaks";
  if (judged({window}) && recipe.focus.window_px % 2 == 0) {
    refuse(window, recipe.focus.window_px, "is even; expected an odd number so that a pixel is its centre");
  }
  const std::string focus_operator = places.focus + "/operator";
  if (judged({window, focus_operator}) && recipe.focus.window_px == 1 &&
      !has_point_window(recipe.focus.focus_operator)) {
    refuse(window, recipe.focus.window_px,
           "is for the intensity; expected 3..63 for a sharpness, which needs a window");
  }
  const std::string second_peak = "/reconstruct/holes/second_peak";
  const double second_peak_limit = recipe.focus.tests.second_peak;
  if (judged({second_peak}) && second_peak_limit > 0.0 && second_peak_limit < kLeastSecondPeak) {
    refuse(second_peak, second_peak_limit,
           "finds hardly any second peak, for noise fills the valley before it; expected 0 or 0.5..1");
  }
  if (judged({mode, trigger}) && recipe.mode == ScanMode::kContinuous && recipe.camera.trigger == TriggerMode::kLine) {
    refuse(trigger, "line", "is for scan.mode step; in a continuous scan the camera runs free");
  }
  const std::string direction = places.scan + "/direction";
  if (judged({mode, direction}) && recipe.mode == ScanMode::kContinuous && recipe.downwards) {
    refuse(direction, "down",
           "is for scan.mode step: in a continuous scan what differs between the directions is the lag of the stage's "
           "clock, not the stage's own");
  }
  if (judged({peak, extra_peaks}) &&
      std::find(recipe.extra_peaks.begin(), recipe.extra_peaks.end(), recipe.peak) != recipe.extra_peaks.end()) {
    refuse(extra_peaks, peak_method_name(recipe.peak), "is the peak already; expected others only");
  }
  if (judged({"/acquire/repeat"}) && recipe.repeat > 1 && recipe.keep_slices) {
    refuse("/acquire/repeat", recipe.repeat,
           "with keep.slices would mix the slices of several scans in one folder; expected 1, or keep.slices false");
  }
  if (judged({"/acquire/repeat", extra_peaks}) && recipe.repeat > 1 && !recipe.extra_peaks.empty()) {
    refuse("/acquire/repeat", recipe.repeat,
           "gives the mean of one map; expected 1, or no further maps at " + extra_peaks);
  }
  const std::string smooth = "/reconstruct/smooth_px";
  if (!judged({"/export", extra_peaks, smooth})) return;
  const auto chosen = chosen_exporters(recipe.exports.value_or(std::vector<std::string>{}));
  const auto makes_none = [&recipe](const Exporter& exporter) {
    return (exporter.need == ExportNeed::kEachExtraMap && recipe.extra_peaks.empty()) ||
           (exporter.need == ExportNeed::kSmoothedMap && !recipe.smooth_px) ||
           (exporter.need == ExportNeed::kRepeatedScans && recipe.repeat == 1);
  };
  if (chosen.empty() || !std::all_of(chosen.begin(), chosen.end(), makes_none)) return;
  refuse("/export", chosen.front().name,
         "stands for maps that the recipe does not ask for, so no file is made; expected methods at " + extra_peaks +
             " for height_*.tiff, a value at " + smooth +
             " for the smoothed map, more than 1 at /acquire/repeat for repeat_sd.*, or names that make files: " +
             names_of_single_files());
}

}  // namespace

bool is_recipe_id(std::string_view id) noexcept {
  const auto allowed = [](char c) {
    return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  };
  return !id.empty() && id.size() <= kMaxIdLength && std::all_of(id.begin(), id.end(), allowed);
}

std::string recipe_sha256(std::string_view bytes) {
  const std::unique_ptr<char, decltype(&g_free)> digest(
      g_compute_checksum_for_data(G_CHECKSUM_SHA256, reinterpret_cast<const guchar*>(bytes.data()), bytes.size()),
      &g_free);
  return digest.get();
}

Recipe read_recipe(std::string_view json_text, const std::string& id, Problems& problems) {
  Recipe recipe;
  if (json_text.size() > kMaxRecipeBytes) {
    problems.push_back({"", "has " + std::to_string(json_text.size()) + " bytes; expected at most " +
                                std::to_string(kMaxRecipeBytes)});
  } else if (const auto document = parse_strict_json(json_text, problems)) {
    const bool format_1 = is_format_1(*document);
    FieldReader reader(*document, problems);
    format_1 ? describe_format_1(recipe, reader) : describe(recipe, reader);
    reader.finish();
    recipe.format = format_1 ? 1 : 2;
    check_together(recipe, format_1 ? kFormat1Places : kFormat2Places, problems);
    check_plan(recipe.evaluation, "/evaluation", problems);
    require_pitch(recipe, *document, problems);
    recipe.evaluation.order = measurement_order(json_text);
    if (format_1) recipe.notes.emplace_back("has format 1, read as format 2; 'fvdctl recipe convert FILE' writes that");
  }
  // Frames wait for their position, and for those before them to be complete, while the camera goes on.
  if (recipe.mode == ScanMode::kContinuous) recipe.camera.pool_frames = kContinuousPoolFrames;
  recipe.id = id;
  recipe.sha256 = recipe_sha256(json_text);
  return recipe;
}

Recipe parse_recipe(std::string_view json_text, const std::string& id) {
  Problems problems;
  Recipe recipe = read_recipe(json_text, id, problems);
  throw_if_any(problems, ErrorCode::kBadRecipe, "recipe " + id);
  return recipe;
}

std::string convert_recipe(std::string_view json_text, const std::string& id) {
  const Recipe recipe = parse_recipe(json_text, id);
  if (recipe.format == 2) {
    throw_if_any({{"/format", "is 2 already: there is nothing to convert"}}, ErrorCode::kBadRecipe, "recipe " + id);
  }
  using nlohmann::ordered_json;
  const ordered_json old = ordered_json::parse(json_text, nullptr, true, true);
  ordered_json made = ordered_json::object();
  if (old.contains("$schema")) made["$schema"] = old["$schema"];
  made["format"] = kRecipeFormat;
  const auto move = [&](const char* from, const char* to) {
    const ordered_json::json_pointer source(from);
    if (old.contains(source)) made[ordered_json::json_pointer(to)] = old[source];
  };
  move("/description", "/description");
  move("/scan", "/acquire/scan");
  move("/camera", "/acquire/camera");
  move("/focus", "/reconstruct/focus");
  move("/lateral", "/reconstruct/lateral");
  move("/result/min_valid_fraction", "/reconstruct/min_valid_fraction");
  move("/result/record_slices", "/keep/slices");
  return made.dump(2) + "\n";
}

Problems check_stage_limits(const Recipe& recipe, const StageLimits& stage, const Problems& read) {
  Problems problems;
  const std::string scan = recipe.format == 1 ? kFormat1Places.scan : kFormat2Places.scan;
  const auto judged = [&](const std::string& key) { return !is_reported(read, scan + key); };
  const double take_up = stage.take_up.value;
  const double below = recipe.downwards ? 0.0 : take_up;
  const double above = recipe.downwards ? take_up : 0.0;
  const double first = recipe.start_um - below;
  const double last = recipe.start_um + recipe.step_um * (recipe.slices - 1) + above;
  const auto with_take_up = [take_up](double um) {
    std::ostringstream text;
    if (um > 0.0) text << " with " << take_up << " um of take-up";
    return text.str();
  };
  if (judged("/start_um") && first < stage.min.value) {
    std::ostringstream text;
    text << recipe.start_um << with_take_up(below) << " reaches " << first << " um; expected a start of at least "
         << stage.min.value + below << " um";
    problems.push_back({scan + "/start_um", text.str()});
  }
  if (judged("/start_um") && judged("/step_um") && judged("/slices") && last > stage.max.value) {
    std::ostringstream text;
    text << recipe.slices << " slices" << with_take_up(above) << " reach " << last << " um; expected at most "
         << stage.max.value << " um: fewer slices, a smaller step_um or a lower start_um";
    problems.push_back({scan + "/slices", text.str()});
  }
  const double speed = recipe.speed_um_per_s;
  if (recipe.mode == ScanMode::kContinuous && judged("/mode") && judged("/speed_um_per_s") &&
      !(speed > 0.0 && speed <= stage.speed_um_per_s)) {
    std::ostringstream text;
    text << speed << " um/s is no speed of a continuous scan; expected above 0 and at most the stage's "
         << stage.speed_um_per_s << " um/s";
    problems.push_back({scan + "/speed_um_per_s", text.str()});
  }
  return problems;
}

}  // namespace fvd
