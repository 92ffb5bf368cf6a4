#include "daemon/recipe_book.hpp"

#include <glib.h>

#include <algorithm>
#include <array>
#include <memory>
#include <sstream>

#include <nlohmann/json.hpp>

#include "config/field_reader.hpp"
#include "config/field_writer.hpp"
#include "config/strict_json.hpp"
#include "core/focus/streaming_focus_stack.hpp"

namespace fvd {

namespace {

constexpr std::array kFormats{PixelFormat::kMono8, PixelFormat::kMono10, PixelFormat::kMono12, PixelFormat::kMono16};
const std::vector<std::string> kFormatNames{"Mono8", "Mono10", "Mono12", "Mono16"};

std::vector<std::string> peak_names() {
  std::vector<std::string> names;
  for (const PeakMethod method : kAllPeakMethods) names.emplace_back(peak_method_name(method));
  return names;
}

template <typename Duration>
void duration_field(Fields& fields, std::string_view name, Duration& value, IntegerRange range, std::string_view meaning) {
  auto count = value.count();
  fields.integer(name, count, range, meaning);
  value = Duration(count);
}

void describe_scan(Recipe& recipe, Fields& fields) {
  fields.number("start_um", recipe.start_um, {-1e6, 1e6}, "z of the first slice");
  fields.number("step_um", recipe.step_um, positive(10000.0), "distance of slices");
  fields.integer("slices", recipe.slices, {3, StreamingFocusStack::kMaxSlices}, "number of slices");
  fields.integer("frame_retries", recipe.frame_retries, {0, 100}, "further triggers for a slice whose frame was lost");
  fields.integer("allowed_lost_slices", recipe.allowed_lost_slices, {0, 1000}, "more fail the job");
  for (const char* name : {"start_um", "step_um", "slices"}) fields.require(name);
  fields.group("settle", "when the axis counts as arrived", [&](Fields& settle) {
    settle.number("window_um", recipe.settle.window.value, positive(100.0), "largest distance from the target");
    settle.integer("samples", recipe.settle.samples, {1, 1000}, "consecutive samples inside the window");
    duration_field(settle, "dwell_ms", recipe.settle.dwell, {0, 10000}, "time the samples span");
    duration_field(settle, "timeout_ms", recipe.settle.timeout, {10, 600000}, "from the start of the move");
  });
}

void describe_camera(CameraSettings& camera, Fields& fields) {
  const auto format = std::find(kFormats.begin(), kFormats.end(), camera.pixel_format) - kFormats.begin();
  std::string name = kFormatNames[static_cast<std::size_t>(format)];
  fields.choice("pixel_format", name, kFormatNames, "PFNC name");
  camera.pixel_format =
      kFormats[static_cast<std::size_t>(std::find(kFormatNames.begin(), kFormatNames.end(), name) - kFormatNames.begin())];
  fields.integer("width_px", camera.width, {0, 65535}, "0 = the whole sensor");
  fields.integer("height_px", camera.height, {0, 65535}, "0 = the whole sensor");
  fields.integer("offset_x_px", camera.offset_x, {0, 65535}, "left edge of the region");
  fields.integer("offset_y_px", camera.offset_y, {0, 65535}, "upper edge of the region");
  fields.number("exposure_us", camera.exposure_us, positive(1e7), "exposure time");
  fields.number("gain_db", camera.gain_db, {-20.0, 60.0}, "analog gain");
}

void describe_focus(Recipe& recipe, Fields& fields) {
  fields.integer("window_px", recipe.focus.window_px, {kMinWindowPx, kMaxWindowPx}, "side of the window, odd");
  fields.number("min_prominence", recipe.focus.min_prominence, {0.0, 1.0}, "below it a point is a hole");
  std::string peak(peak_method_name(recipe.peak));
  fields.choice("peak", peak, peak_names(), "how the sub-slice height is found");
  recipe.peak = *peak_method_from_name(peak);
  std::vector<std::string> extra;
  for (const PeakMethod method : recipe.extra_peaks) extra.emplace_back(peak_method_name(method));
  fields.choices("extra_peaks", extra, peak_names(), "further height maps of the same scan");
  recipe.extra_peaks.clear();
  for (const std::string& name : extra) recipe.extra_peaks.push_back(*peak_method_from_name(name));
}

void check_together(const Recipe& recipe, Problems& problems) {
  if (recipe.focus.window_px % 2 == 0) {
    problems.push_back({"/focus/window_px", std::to_string(recipe.focus.window_px) + " is even; expected an odd integer within 3..63"});
  }
  if (recipe.allowed_lost_slices > recipe.slices - 3) {
    problems.push_back({"/scan/allowed_lost_slices", std::to_string(recipe.allowed_lost_slices) +
                                                         " leaves fewer than 3 of " + std::to_string(recipe.slices) + " slices"});
  }
  if (std::find(recipe.extra_peaks.begin(), recipe.extra_peaks.end(), recipe.peak) != recipe.extra_peaks.end()) {
    problems.push_back({"/focus/extra_peaks", "repeats the method of /focus/peak"});
  }
}

std::string sha256(const std::string& text) {
  const std::unique_ptr<char, decltype(&g_free)> digest(
      g_compute_checksum_for_data(G_CHECKSUM_SHA256, reinterpret_cast<const guchar*>(text.data()), text.size()), &g_free);
  return digest.get();
}

/// Ids become file names; nothing but plain names may.
bool is_plain_name(const std::string& id) {
  return !id.empty() && id.size() <= 32 && std::all_of(id.begin(), id.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  });
}

}  // namespace

void describe(Recipe& recipe, Fields& fields) {
  fields.text("description", recipe.description, 1000, "for people");
  fields.group("scan", "where the slices lie", [&](Fields& group) { describe_scan(recipe, group); });
  fields.group("camera", "what the camera is set to", [&](Fields& group) { describe_camera(recipe.camera, group); });
  fields.group("focus", "how heights are computed", [&](Fields& group) { describe_focus(recipe, group); });
  fields.group("lateral", "scale of the image on the object", [&](Fields& group) {
    group.number("pixel_pitch_x_um", recipe.pixel_pitch_x_um, positive(10000.0), "distance of pixels");
    group.number("pixel_pitch_y_um", recipe.pixel_pitch_y_um, positive(10000.0), "distance of rows");
  });
  fields.group("result", "what is kept and when a job fails", [&](Fields& group) {
    group.number("min_valid_fraction", recipe.min_valid_fraction, {0.0, 1.0}, "fewer valid points fail the job");
    group.boolean("record_slices", recipe.record_slices, "also keep the slices and their z");
  });
}

std::vector<std::string> list_recipes(const std::filesystem::path& folder) {
  std::vector<std::string> ids;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    if (entry.path().extension() == ".json" && is_plain_name(entry.path().stem())) ids.push_back(entry.path().stem());
  }
  if (error) throw Error(ErrorCode::kBadInput, "cannot read the recipes in " + folder.string() + ": " + error.message());
  std::sort(ids.begin(), ids.end());
  return ids;
}

std::string recipe_text(const std::filesystem::path& folder, const std::string& id) {
  if (!is_plain_name(id)) {
    throw Error(ErrorCode::kUnknownRecipe, "a recipe id has 1 to 32 letters, digits, '-' or '_'");
  }
  const auto file = folder / (id + ".json");
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) {
    throw Error(ErrorCode::kUnknownRecipe, "there is no recipe '" + id + "'; recipe.list names those there are");
  }
  return read_text_file(file);
}

Recipe parse_recipe(std::string_view text, const std::string& id) {
  Recipe recipe;
  recipe.id = id;
  Problems problems;
  read_document(text, [&recipe](Fields& fields) { describe(recipe, fields); }, problems);
  if (problems.empty()) check_together(recipe, problems);
  throw_if_any(problems, ErrorCode::kBadRecipe, "recipe " + id);
  // The digest of what the recipe says, not of how it is written: spaces, comments and defaults do not change it.
  recipe.sha256 = sha256(fields_to_json([&recipe](Fields& fields) { describe(recipe, fields); }).dump());
  return recipe;
}

Recipe load_recipe(const std::filesystem::path& folder, const std::string& id) {
  return parse_recipe(recipe_text(folder, id), id);
}

std::string recipe_schema_text() {
  Recipe defaults;
  return fields_to_schema([&defaults](Fields& fields) { describe(defaults, fields); }, "fvd recipe").dump(2) + "\n";
}

}  // namespace fvd
