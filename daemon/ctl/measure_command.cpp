#include "daemon/ctl/measure_command.hpp"

#include <algorithm>
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
#include "daemon/ctl/evaluation_text.hpp"
#include "daemon/ctl/exit_codes.hpp"
#include "daemon/ctl/pitch_option.hpp"
#include "daemon/ctl/process_command.hpp"
#include "daemon/ctl/readable_range.hpp"
#include "daemon/evaluation/evaluate_surface.hpp"
#include "daemon/export/atomic_directory.hpp"
#include "daemon/pipeline/stored_surface.hpp"
#include "daemon/recipes/recipe_masks.hpp"

namespace fvd::ctl {

namespace {

namespace fs = std::filesystem;

/// Of a file only the surface.
StoredSurface read_input(const MeasureArguments& arguments) {
  const SurfaceReadOptions options = read_options(arguments.pitch_um);
  if (fs::is_directory(arguments.source)) return read_stored_surface(arguments.source, options);
  StoredSurface input;
  input.surface = read_surface(arguments.source, options);
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
  command.add_option("--out", a.out, "new folder for evaluation.json");
  command.add_flag("--json", a.json, "print all of it as JSON in place of the summary");
}

int run_measure(const MeasureArguments& arguments, const Terminal& terminal) {
  const std::optional<Recipe> recipe = read_measured_recipe(arguments.recipe, terminal);
  if (!recipe) return kExitConfig;
  StoredSurface input = read_input(arguments);
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
