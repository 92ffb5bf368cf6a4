/// What the range of a single key cannot say: values that must fit together, files that must be there.

#include <algorithm>
#include <iterator>
#include <sstream>

#include <arpa/inet.h>

#include "daemon/config/config_file.hpp"
#include "drivers/modbus/modbus_transport.hpp"

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

void check_camera(const CameraConfig& camera, Problems& problems) {
  if (camera.driver == "aravis" && camera.address.empty()) {
    problems.push_back({"/camera/address", "is empty; expected the camera's IP address or vendor-model-serial"});
  }
  if (camera.driver != "replay") return;
  if (const std::string problem = folder_problem(camera.replay_dir); !problem.empty()) {
    problems.push_back({"/camera/replay_dir", problem});
  }
}

void check_stage(const StageConfig& stage, Problems& problems) {
  if (stage.min >= stage.max) {
    problems.push_back({"/stage/min_um", text(stage.min.value) + " is not below max_um, " + text(stage.max.value)});
  } else if (stage.take_up >= stage.max - stage.min) {
    problems.push_back({"/stage/take_up_um", text(stage.take_up.value) + " leaves no room between min_um and max_um, " +
                                                 text((stage.max - stage.min).value) + " apart"});
  }
  if (stage.driver != "modbus") return;
  if (stage.transport == "tcp" && stage.address.empty()) {
    problems.push_back({"/stage/address", "is empty; expected the drive's host or IP address"});
  }
  if (stage.transport == "rtu") {
    if (stage.serial_device.empty()) {
      problems.push_back({"/stage/serial_device", "is empty; expected a serial port such as /dev/serial/by-id/..."});
    }
    if (std::find(std::begin(kModbusBauds), std::end(kModbusBauds), stage.serial_baud) == std::end(kModbusBauds)) {
      std::string bauds;
      for (const int baud : kModbusBauds) bauds += " " + std::to_string(baud);
      problems.push_back(
          {"/stage/serial_baud", std::to_string(stage.serial_baud) + " is not accepted; expected one of" + bauds});
    }
  }
  std::error_code error;
  if (!fs::is_regular_file(stage.profile, error)) {
    problems.push_back({"/stage/profile", "there is no file '" + stage.profile.string() +
                                              "'; expected a drive profile such as drives/oriental-az.json"});
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
  check_camera(config.camera, problems);
  check_stage(config.stage, problems);
  if ((config.camera.driver == "replay") != (config.stage.driver == "replay")) {
    problems.push_back({"/stage/driver", "'" + config.stage.driver + "' does not go with camera driver '" +
                                             config.camera.driver + "': recorded slices need both to be replay"});
  }
  check_paths(config.paths, problems);
  return problems;
}

}  // namespace fvd
