#include "daemon/options.hpp"

#include <CLI/CLI.hpp>

#include "daemon/version.hpp"

namespace fvd {

ParsedOptions parse_options(int argc, char** argv) {
  ParsedOptions parsed;
  Options& options = parsed.options;
  CLI::App app{"fvd: focus-variation acquisition daemon", "fvd"};
  app.set_version_flag("--version", std::string("fvd ") + kVersion);
  app.add_option("--config", options.config_file, "configuration file")->capture_default_str();
  app.add_option("--set", options.overrides, "override one key, e.g. --set rpc.port=0")->allow_extra_args(false);
  app.add_flag("--check-config", options.check_config, "check the configuration and every recipe, print all problems, exit 0 or 78");
  app.add_flag("--dump-config", options.dump_config, "print the configuration in force and exit");
  app.add_flag("--print-schema", options.print_schema, "print the JSON schema of the configuration and exit");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    parsed.exit = app.exit(error) == 0 ? exit_code::kOk : exit_code::kUsage;
  }
  return parsed;
}

}  // namespace fvd
