#include "daemon/ctl/measure_command.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>
#include <utility>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "config/field_writer.hpp"
#include "config/strict_json.hpp"
#include "core/base/error.hpp"
#include "core/base/units.hpp"
#include "core/runtime/worker_pool.hpp"
#include "daemon/calibration/calibration_book.hpp"
#include "daemon/ctl/evaluation_text.hpp"
#include "daemon/ctl/exit_codes.hpp"
#include "daemon/ctl/pitch_option.hpp"
#include "daemon/ctl/process_command.hpp"
#include "daemon/ctl/readable_range.hpp"
#include "daemon/evaluation/evaluate_surface.hpp"
#include "daemon/export/atomic_directory.hpp"
#include "daemon/pipeline/evaluation_input.hpp"
#include "daemon/pipeline/stored_surface.hpp"
#include "daemon/recipes/recipe_masks.hpp"
#include "daemon/surface_files/reference_map.hpp"

namespace fvd::ctl {

namespace {

namespace fs = std::filesystem;

/// The reference map of the constants that the surface is evaluated with, where they name one.
void read_reference(const std::string& folder, EvaluationContext& context) {
  const auto& calibration = context.calibration;
  if (!calibration || !calibration->flatness || calibration->flatness->reference.empty()) return;
  context.flatness_reference = read_reference_map(folder, calibration->flatness->reference);
}

/// A surface from elsewhere is taken to be of this instrument as it is now.
void use_newest_constants(const MeasureArguments& arguments, const Terminal& terminal, EvaluationContext& context) {
  if (arguments.calibration.empty()) {
    if (!arguments.objective.empty()) throw UsageError("--objective is for --calibration, which is not given");
    return;
  }
  context.calibration = CalibrationBook(arguments.calibration).current(arguments.objective);
  if (!context.calibration) {
    throw UsageError(arguments.calibration + " has no constants of " +
                     (arguments.objective.empty() ? "an instrument without a named objective; say --objective"
                                                  : "the objective " + arguments.objective));
  }
  const std::string parts = lapsed_text(*context.calibration, calendar_day(std::chrono::system_clock::now()));
  if (!parts.empty()) {
    terminal.err << "fvdctl: calibration " << context.calibration->id << " is past the day to be renewed by: " << parts
                 << "\n";
  }
  read_reference(arguments.calibration, context);
}

/// A result tells its constants itself; the folder, of the same instrument, has the map that they name.
void use_folder_of_constants(const MeasureArguments& arguments, EvaluationContext& context) {
  if (!arguments.objective.empty()) throw UsageError("--objective is for files; a result tells its own");
  if (arguments.calibration.empty() || !context.calibration) return;
  if (CalibrationBook(arguments.calibration).find(context.calibration->id) != context.calibration) {
    throw UsageError(arguments.calibration + " has other constants than the result by the name " +
                     context.calibration->id + ": it is another instrument's");
  }
  read_reference(arguments.calibration, context);
}

StoredSurface read_input(const MeasureArguments& arguments, const Terminal& terminal) {
  const SurfaceReadOptions options = read_options(arguments.pitch_um);
  if (fs::is_directory(arguments.source)) {
    StoredSurface input = read_stored_surface(arguments.source, options);
    use_folder_of_constants(arguments, input.context);
    return input;
  }
  StoredSurface input;
  input.surface = read_surface(arguments.source, options);
  use_newest_constants(arguments, terminal, input.context);
  return input;
}

void set_noise(double noise_um, Surface& surface) {
  if (!std::isfinite(noise_um) || noise_um <= 0.0) throw UsageError("--noise-um expects a length above 0");
  if (surface.has_sigma()) throw UsageError("--noise-um is for a surface without standard errors; this one has them");
  surface.sigma_m = Plane<float>::unset(surface.width(), surface.height());
  const auto sigma_m = static_cast<float>(noise_um * kMetresPerMicrometer);
  std::transform(surface.height_m.pixels().begin(), surface.height_m.pixels().end(), surface.sigma_m.pixels().begin(),
                 [sigma_m](float height) { return std::isnan(height) ? height : sigma_m; });
}

/// Nothing where the recipe was refused, which is said on err.
std::optional<Recipe> read_measured_recipe(const std::string& file, const Terminal& terminal) {
  try {
    Recipe recipe = read_recipe_file(file);
    if (!recipe.evaluation.empty()) return recipe;
    terminal.err << "fvdctl: recipe " << file << ": /evaluation: has no measurements, so that there is nothing to do\n";
  } catch (const Error& error) {
    if (error.code() != ErrorCode::kBadRecipe) throw;
    terminal.err << "fvdctl: " << error.what() << "\n";
  }
  return std::nullopt;
}

std::string json_text(Evaluation evaluation) {
  return fields_to_json([&](Fields& fields) { describe(evaluation, fields); }).dump(2) + "\n";
}

}  // namespace

void add_measure_options(CLI::App& command, MeasureArguments& a) {
  command.footer("Names, units and meanings of the values: daemon/evaluation/README.md, section Values.");
  command.add_option("source", a.source, "folder of a result, or a file of a surface: X3P, GSF, SDF, float TIFF, CSV")
      ->required();
  command.add_option("--recipe", a.recipe, "file of a recipe with a section evaluation")
      ->required()
      ->check(CLI::ExistingFile);
  add_pitch_option(command, a.pitch_um);
  command
      .add_option("--noise-um", a.noise_um,
                  "standard error of every point, where the source has none; without it U is not known")
      ->check(PositiveCheck());
  command
      .add_option("--calibration", a.calibration,
                  "folder of calibration.json: of a result only for the reference map that its constants name; of a "
                  "file, the newest constants there")
      ->check(CLI::ExistingDirectory);
  command.add_option("--objective", a.objective, "whose constants a file is evaluated with");
  command.add_option("--out", a.out, "new folder for evaluation.json");
  command.add_flag("--json", a.json, "print all of it as JSON in place of the summary");
}

int run_measure(const MeasureArguments& arguments, const Terminal& terminal) {
  const std::optional<Recipe> recipe = read_measured_recipe(arguments.recipe, terminal);
  if (!recipe) return kExitConfig;
  StoredSurface input = read_input(arguments, terminal);
  keep_repeatability_of(*recipe, input.result, input.context);
  if (arguments.noise_um) set_noise(*arguments.noise_um, input.surface);
  WorkerPool pool(0);
  const Evaluation evaluation = evaluate_surface(input.surface, recipe->evaluation, input.context, &pool);
  const std::string json = json_text(evaluation);
  if (!arguments.out.empty()) {
    AtomicDirectory directory(arguments.out);
    directory.add_file("evaluation.json", json);
    directory.commit();
  }
  terminal.out << (arguments.json ? json : evaluation_text(evaluation));
  if (!arguments.json && evaluation.verdict) terminal.out << "verdict   " << verdict_name(*evaluation.verdict) << "\n";
  terminal.out << std::flush;
  return exit_code_of(evaluation.verdict);
}

}  // namespace fvd::ctl
