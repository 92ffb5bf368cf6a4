/// What the range of a single key cannot say: values that must fit together, files that must be there.

#include <sstream>

#include <arpa/inet.h>

#include "daemon/config/config_file.hpp"
#include "drivers/registry/driver_table.hpp"

namespace fvd {

namespace {

namespace fs = std::filesystem;

std::string text(double value) {
  std::ostringstream out;
  out << value;
  return out.str();
}

bool is_numeric_address(const std::string& address) {
  in6_addr storage{};
  return inet_pton(AF_INET, address.c_str(), &storage) == 1 || inet_pton(AF_INET6, address.c_str(), &storage) == 1;
}

/// Empty if the folder can be listed.
std::string folder_problem(const fs::path& folder) {
  std::error_code error;
  const fs::directory_iterator entries(folder, error);
  return error ? "cannot list folder '" + folder.string() + "': " + error.message() : "";
}

void check_rpc(const RpcConfig& rpc, Problems& problems) {
  if (!is_numeric_address(rpc.address)) {
    problems.push_back({"/rpc/address", "'" + rpc.address +
                                            "' is no numeric address; expected e.g. 127.0.0.1 for this machine only "
                                            "or 0.0.0.0 for every interface"});
  }
}

void check_stage(const StageConfig& stage, Problems& problems) {
  if (stage.min >= stage.max) {
    problems.push_back({"/stage/min_um", text(stage.min.value) + " is not below max_um, " + text(stage.max.value)});
  } else if (stage.take_up >= stage.max - stage.min) {
    problems.push_back({"/stage/take_up_um", text(stage.take_up.value) + " leaves no room between min_um and max_um, " +
                                                 text((stage.max - stage.min).value) + " apart"});
  }
}

void check_paths(const PathsConfig& paths, Problems& problems) {
  if (paths.state_dir.empty()) problems.push_back({"/paths/state_dir", "is empty; expected a folder"});
  if (paths.runtime_dir.empty()) problems.push_back({"/paths/runtime_dir", "is empty; expected a folder"});
  if (const std::string problem = folder_problem(paths.recipe_dir); !problem.empty()) {
    problems.push_back({"/paths/recipe_dir", problem});
  }
}

}  // namespace

Problems check_config(const Config& config) {
  Problems problems;
  check_rpc(config.rpc, problems);
  check_driver(config.camera, problems);
  check_stage(config.stage, problems);
  check_driver(config.stage, problems);
  if ((config.camera.driver == "replay") != (config.stage.driver == "replay")) {
    problems.push_back({"/stage/driver", "'" + config.stage.driver + "' does not go with camera driver '" +
                                             config.camera.driver + "': recorded slices need both to be replay"});
  }
  check_paths(config.paths, problems);
  return problems;
}

}  // namespace fvd
