#include "daemon/options.hpp"

#include <ostream>

#include <CLI/CLI.hpp>

#include "config/strict_json.hpp"
#include "core/base/error.hpp"
#include "daemon/base/exit_code.hpp"
#include "daemon/base/version.hpp"
#include "daemon/recipes/recipe_document.hpp"
#include "daemon/recipes/recipe_masks.hpp"
#include "daemon/station_check.hpp"
#include "drivers/modbus/drive_profile.hpp"

namespace fvd {

ParsedOptions parse_options(int argc, const char* const* argv, std::ostream& out, std::ostream& err) {
  ParsedOptions parsed;
  Options& options = parsed.options;
  CLI::App app("fvd: live focus-variation acquisition daemon", "fvd");
  app.set_version_flag("--version", std::string("fvd ") + kVersion);
  app.add_option("--config", options.config_file,
                 "configuration file; what conf.d/*.json beside it says is merged into it")
      ->capture_default_str()
      ->type_name("FILE");
  app.add_option("--set", options.overrides, "put a value over the file's, e.g. rpc.port=0; may be repeated")
      ->type_name("GROUP.KEY=VALUE")
      ->allow_extra_args(false);
  app.add_flag("--new-database", options.new_database,
               "start though the database is gone: no job of before is known, the epoch goes on");
  app.add_flag(
      "--check-config", options.check_config,
      "say every problem of the configuration, its drive profile, its recipes and its folders on stderr and exit: "
      "0 = none but warnings, 78 = some");
  app.add_option("--check-recipe", options.check_recipe,
                 "say every problem of a recipe on stderr and exit: 0 = none, 78 = some; with --config or --set the "
                 "limits of that configuration's stage count too")
      ->type_name("FILE");
  app.add_flag("--dump-config", options.dump_config,
               "print the configuration in force as JSON, with the origin of every value, and exit");
  app.add_flag("--print-config-schema", options.print_config_schema, "print the configuration's JSON schema and exit");
  app.add_flag("--print-recipe-schema", options.print_recipe_schema, "print the recipes' JSON schema and exit");
  app.add_flag("--print-drive-schema", options.print_drive_schema, "print the drive profiles' JSON schema and exit");
  try {
    app.parse(argc, argv);
    options.config_is_told = app.count("--config") + app.count("--set") > 0;
  } catch (const CLI::ParseError& error) {
    parsed.exit = app.exit(error, out, err) == 0 ? exit_code::kOk : exit_code::kUsage;
  }
  return parsed;
}

namespace {

int check_recipe(const std::filesystem::path& file, const StageLimits* stage, std::ostream& err) {
  try {
    const Recipe recipe = read_recipe_file(file, stage);
    for (const std::string& note : recipe.notes) err << file.string() << ": note: " << note << std::endl;
    return exit_code::kOk;
  } catch (const Error& error) {
    err << error.what() << std::endl;
    return exit_code::kConfig;
  }
}

}  // namespace

StartUp start_up(const Options& options, std::ostream& out, std::ostream& err) {
  StartUp result;
  if (options.print_config_schema || options.print_recipe_schema || options.print_drive_schema) {
    out << (options.print_config_schema   ? config_schema_text()
            : options.print_recipe_schema ? recipe_schema_text()
                                          : drive_profile_schema_text());
    result.exit = exit_code::kOk;
    return result;
  }
  if (!options.check_recipe.empty() && !options.config_is_told) {
    result.exit = check_recipe(options.check_recipe, nullptr, err);
    return result;
  }
  LoadedConfig loaded = load_config(options.config_file, options.overrides);
  if (!loaded.problems.empty()) {
    err << to_text(loaded.problems, options.config_file.string()) << std::endl;
    result.exit = exit_code::kConfig;
    return result;
  }
  if (!options.check_recipe.empty()) {
    const StageConfig& stage = loaded.config.stage;
    const StageLimits limits{stage.min, stage.max, stage.take_up, stage.speed_um_per_s};
    result.exit = check_recipe(options.check_recipe, &limits, err);
    return result;
  }
  if (options.check_config) {
    const StationCheck station = check_station(loaded.config);
    if (!station.warnings.empty()) {
      err << to_text(station.warnings, options.config_file.string() + ": warning") << std::endl;
    }
    if (!station.problems.empty()) {
      err << to_text(station.problems, options.config_file.string()) << std::endl;
      result.exit = exit_code::kConfig;
      return result;
    }
  }
  if (options.dump_config) out << config_text_with_origins(loaded);
  if (options.dump_config || options.check_config) result.exit = exit_code::kOk;
  result.config = std::move(loaded.config);
  return result;
}

}  // namespace fvd
