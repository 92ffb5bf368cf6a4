#pragma once

/// The command line of fvd.

#include <filesystem>
#include <iosfwd>
#include <optional>

#include "daemon/config/config_file.hpp"

namespace fvd {

struct Options {
  std::filesystem::path config_file = "/etc/fvd/fvd.json";
  Overrides overrides;
  bool check_config = false;
  bool dump_config = false;
  std::filesystem::path check_recipe;  ///< a recipe's file; empty = none
  bool print_config_schema = false;
  bool print_recipe_schema = false;
  bool print_drive_schema = false;
};

/// The options, or the exit code where the command line says it all (--help, --version) or is wrong.
struct ParsedOptions {
  Options options;
  std::optional<int> exit;
};
/// Writes help and version to out, complaints to err.
[[nodiscard]] ParsedOptions parse_options(int argc, const char* const* argv, std::ostream& out, std::ostream& err);

/// Loads the configuration and does what the options ask for beyond running: prints every problem to err, or the
/// effective configuration or a schema to out. Gives the exit code, or nothing and the configuration to run with.
struct StartUp {
  Config config;
  std::optional<int> exit;
};
[[nodiscard]] StartUp start_up(const Options& options, std::ostream& out, std::ostream& err);

}  // namespace fvd
