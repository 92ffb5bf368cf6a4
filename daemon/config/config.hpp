#pragma once

/// The daemon's configuration as plain values. Ranges in the comments are what config_check accepts.

#include <cstdint>
#include <filesystem>
#include <string>

#include "drivers/registry/driver_table.hpp"

namespace fvd {

struct RpcConfig {
  std::string address = "127.0.0.1";  ///< numeric address to listen on
  int port = 7411;                    ///< 0..65535, 0 = any free port, written to <runtime_dir>/rpc.json
  int max_connections = 16;           ///< 1..1000
  int idle_timeout_s = 120;           ///< 1..86400; a connection that sends nothing for this long is closed
};

struct PathsConfig {
  std::filesystem::path state_dir = "/var/lib/fvd";  ///< database and results/
  std::filesystem::path runtime_dir = "/run/fvd";    ///< rpc.json
  std::filesystem::path recipe_dir = "/etc/fvd/recipes";
};

struct ComputeConfig {
  int threads = 0;               ///< 0..256, 0 = one per core
  int memory_budget_mib = 4096;  ///< 16..1048576; a job that needs more is refused
  int queue_slices = 4;          ///< 1..64, slices between camera and computation
};

struct LogConfig {
  std::string level = "info";  ///< trace, debug, info, warn, error
};

/// With a block for each kind of device.
struct Config : DeviceConfigs {
  RpcConfig rpc;
  PathsConfig paths;
  ComputeConfig compute;
  LogConfig log;
};

}  // namespace fvd
