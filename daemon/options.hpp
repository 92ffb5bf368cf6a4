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
  bool config_is_told = false;  ///< by --config or --set
  bool new_database = false;    ///< start though the database is gone
  bool check_config = false;
  bool dump_config = false;
  std::filesystem::path check_recipe;  ///< a recipe's file; empty = none
  bool print_config_schema = false;
  bool print_recipe_schema = false;
  bool print_drive_schema = false;
};

/// The options, or the exit code if the program ends after parsing: --help, --version, or a wrong command line.
struct ParsedOptions {
  Options options;
  std::optional<int> exit;
};
/// Writes help and version to out, complaints to err.
[[nodiscard]] ParsedOptions parse_options(int argc, const char* const* argv, std::ostream& out, std::ostream& err);

/// The configuration to run with, or the exit code if the program ends without running.
struct StartUp {
  Config config;
  std::optional<int> exit;
};
/// Loads the configuration and does what the options ask for instead of running. Writes every problem to err, the
/// effective configuration or a schema to out.
[[nodiscard]] StartUp start_up(const Options& options, std::ostream& out, std::ostream& err);

}  // namespace fvd
