/// fvd: reads its configuration, starts, and waits for the signal to stop.

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <csignal>
#include <iostream>

#include "core/error.hpp"
#include "daemon/app.hpp"
#include "daemon/options.hpp"
#include "daemon/recipe_book.hpp"
#include "daemon/systemd_notify.hpp"
#include "daemon/version.hpp"

namespace fvd {
namespace {

/// Problems of the recipes, so that a check before the start finds what a PLC would run into.
Problems recipe_problems(const Config& config) {
  Problems problems;
  try {
    for (const std::string& id : list_recipes(config.paths.recipe_dir)) {
      try {
        (void)load_recipe(config.paths.recipe_dir, id);
      } catch (const Error& error) {
        problems.push_back({"", error.what()});
      }
    }
  } catch (const Error& error) {
    problems.push_back({"", error.what()});
  }
  return problems;
}

int check_config(const Options& options, const LoadedConfig& loaded) {
  Problems problems = loaded.problems;
  if (problems.empty()) problems = recipe_problems(loaded.config);
  if (!problems.empty()) {
    std::cerr << to_text(problems, options.config_file.string()) << '\n';
    return exit_code::kConfig;
  }
  std::cout << options.config_file.string() << ": good\n";
  return exit_code::kOk;
}

int exit_code_of(ErrorCode code) {
  switch (code) {
    case ErrorCode::kBadConfig: return exit_code::kConfig;
    case ErrorCode::kStorageWrite:
    case ErrorCode::kStorageFull:
    case ErrorCode::kDatabase: return exit_code::kIo;
    default: return exit_code::kInternal;
  }
}

int serve(const Config& config) {
  spdlog::set_default_logger(spdlog::stderr_color_mt("fvd"));
  spdlog::set_level(spdlog::level::from_str(config.log.level));
  spdlog::info("fvd {} starts", kVersion);
  // Before any thread exists, so that all inherit it: only the wait below sees these signals.
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGTERM);
  sigaddset(&signals, SIGINT);
  sigprocmask(SIG_BLOCK, &signals, nullptr);
  std::signal(SIGPIPE, SIG_IGN);

  App app(config);
  spdlog::info("listening on {}:{}", config.rpc.address, app.rpc_port());
  notify_ready("listening on port " + std::to_string(app.rpc_port()));
  int received = 0;
  sigwait(&signals, &received);
  spdlog::info("signal {}: stopping", received);
  notify_stopping();
  return exit_code::kOk;
}

}  // namespace
}  // namespace fvd

int main(int argc, char** argv) try {
  using namespace fvd;
  const ParsedOptions parsed = parse_options(argc, argv);
  if (parsed.exit) return *parsed.exit;
  if (parsed.options.print_schema) {
    std::cout << config_schema_text();
    return exit_code::kOk;
  }
  const LoadedConfig loaded = load_config(parsed.options.config_file, parsed.options.overrides);
  if (parsed.options.check_config || !loaded.problems.empty()) return check_config(parsed.options, loaded);
  if (parsed.options.dump_config) {
    std::cout << config_text(loaded.config);
    return exit_code::kOk;
  }
  try {
    return serve(loaded.config);
  } catch (const Error& error) {
    spdlog::critical("{}: {}", error_name(error.code()), error.what());
    return exit_code_of(error.code());
  }
} catch (const std::exception& error) {
  std::cerr << "fvd: " << error.what() << '\n';
  return fvd::exit_code::kInternal;
}
