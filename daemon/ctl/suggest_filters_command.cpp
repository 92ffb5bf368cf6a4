#include "daemon/ctl/suggest_filters_command.hpp"

#include <filesystem>

#include <CLI/CLI.hpp>

#include "config/strict_json.hpp"
#include "core/focus/window_kernel.hpp"
#include "daemon/ctl/exit_codes.hpp"
#include "daemon/ctl/pitch_option.hpp"
#include "daemon/ctl/process_command.hpp"
#include "daemon/ctl/readable_range.hpp"
#include "daemon/evaluation/filter_suggestion.hpp"
#include "daemon/export/result_json.hpp"
#include "daemon/recipes/recipe_masks.hpp"

namespace fvd::ctl {

namespace {

/// What the sources tell; each may be absent.
struct Known {
  std::optional<double> pitch_x_um;
  std::optional<double> pitch_y_um;
  std::optional<double> window_px;
  int width_px = 0;  ///< 0 = not told
  int height_px = 0;
};

Known of_recipe(const std::string& file) {
  const Recipe recipe = read_recipe_file(file);
  return {recipe.pixel_pitch_x_um, recipe.pixel_pitch_y_um, window_kernel(focus_settings(recipe)).width_px(),
          recipe.camera.width, recipe.camera.height};
}

Known of_result(const std::string& folder) {
  const Result::Focus focus = read_result_json(read_text_file(std::filesystem::path(folder) / "result.json")).focus;
  return {focus.pixel_pitch_x_um, focus.pixel_pitch_y_um, window_kernel(focus.settings).width_px(), focus.width_px,
          focus.height_px};
}

Known known(const SuggestFiltersArguments& arguments) {
  if (!arguments.recipe.empty()) return of_recipe(arguments.recipe);
  if (!arguments.result.empty()) return of_result(arguments.result);
  return {};
}

OpticalField field_of(const SuggestFiltersArguments& arguments) {
  Known told = known(arguments);
  const SurfaceReadOptions pitch = read_options(arguments.pitch_um);
  if (pitch.pitch_x_um) {
    told.pitch_x_um = pitch.pitch_x_um;
    told.pitch_y_um = pitch.pitch_y_um;
  }
  if (arguments.window_px) told.window_px = arguments.window_px;
  if (!told.pitch_x_um || !told.pitch_y_um) throw UsageError("--pitch-um is missing, or a source that tells it");
  if (!told.window_px) throw UsageError("--window-px is missing, or a source that tells it");
  OpticalField field{*told.pitch_x_um, *told.pitch_y_um, *told.window_px, told.width_px * *told.pitch_x_um,
                     told.height_px * *told.pitch_y_um};
  if (!arguments.field_um.empty()) {
    if (arguments.field_um.size() != 2) throw UsageError("--field-um takes width and height, such as 480,360");
    field.width_um = arguments.field_um[0];
    field.height_um = arguments.field_um[1];
  }
  if (!(field.width_um > 0.0) || !(field.height_um > 0.0)) {
    throw UsageError("--field-um is missing: the source does not tell the size of the image");
  }
  return field;
}

}  // namespace

void add_suggest_filters_options(CLI::App& command, SuggestFiltersArguments& a) {
  CLI::Option* recipe = command.add_option("--recipe", a.recipe, "file of a recipe that tells what is not given")
                            ->check(CLI::ExistingFile);
  command.add_option("--result", a.result, "folder of a result that tells what is not given")
      ->check(CLI::ExistingDirectory)
      ->excludes(recipe);
  add_pitch_option(command, a.pitch_um);
  command.add_option("--window-px", a.window_px, "side of the focus window")->check(PositiveCheck());
  command.add_option("--field-um", a.field_um, "width and height of the field of view, such as 480,360")
      ->delimiter(',')
      ->check(PositiveCheck());
  command.add_flag("--json", a.json, "print only the section evaluation, as JSON");
}

int run_suggest_filters(const SuggestFiltersArguments& arguments, const Terminal& terminal) {
  const FilterSuggestion suggestion = suggest_filters(field_of(arguments));
  if (!arguments.json) terminal.out << suggestion_text(suggestion) << "\n";
  terminal.out << suggestion_json(suggestion) << std::flush;
  return kExitOk;
}

}  // namespace fvd::ctl
