#pragma once

/// The daemon's configuration as plain values. Ranges in the comments are what config_check accepts.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "daemon/access/access_config.hpp"
#include "drivers/registry/driver_table.hpp"

namespace fvd {

struct RpcConfig {
  std::string address = "127.0.0.1";  ///< numeric address to listen on
  int port = 7411;                    ///< 0..65535, 0 = any free port, written to <runtime_dir>/rpc.json
  int max_connections = 16;           ///< 2..1000
  int idle_timeout_s = 120;           ///< 1..86400; a connection that sends nothing for this long is closed
  int repeat_window_s = 600;          ///< 1..31536000; a number is repeated as long as its job ended no longer ago
  int fifo_results = 1000;            ///< 1..1000000; more results that wait are told as an overrun
  int first_request_s = 5;            ///< 1..86400; one that has not made a valid request by then is closed
  std::filesystem::path socket;       ///< the unix socket; empty = <runtime_dir>/fvd.sock
  AccessConfig access;
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

struct HttpHost {
  std::string name;  ///< as in the URL, without scheme and port

  bool operator==(const HttpHost&) const = default;
};

/// For clients that speak HTTP: web pages, other programs.
struct HttpConfig {
  std::string address = "127.0.0.1";  ///< numeric address to listen on
  std::optional<int> port;            ///< 0..65535, 0 = any free port; absent = no HTTP
  std::vector<HttpHost> hosts;        ///< names by which clients may call it, beside its addresses and localhost

  bool operator==(const HttpConfig&) const = default;
};

/// What is removed to make room: of acknowledged results alone, the oldest first, recorded slices before the rest.
struct StoreConfig {
  int keep_days = 0;      ///< 0..36500; older results go; 0 = whatever their age
  int keep_gib = 0;       ///< 0..1048576; of all results; 0 = whatever their size
  int keep_free_gib = 0;  ///< 0..1048576; of the disk; 0 = however full it is

  bool operator==(const StoreConfig&) const = default;
};

struct MetricsConfig {
  std::string address = "127.0.0.1";  ///< numeric address to listen on
  std::optional<int> port;            ///< 0..65535, 0 = any free port; absent = no metrics

  bool operator==(const MetricsConfig&) const = default;
};

/// An objective that can be on the microscope. Which one is there, a person confirms.
struct ObjectiveConfig {
  std::string name;                   ///< unique, 1..64 bytes
  double na = 0.0;                    ///< numerical aperture, above 0 up to 1.7
  double magnification = 0.0;         ///< above 0 up to 1000
  double working_distance_mm = 0.0;   ///< above 0 up to 1000
  std::optional<double> min_um = {};  ///< soft limits of z, inside the stage's; absent = the stage's
  std::optional<double> max_um = {};
};

/// A file that tells the temperature of the part or of the room, as other programs or the kernel write it: one number.
struct TemperatureConfig {
  std::filesystem::path file;  ///< empty = none
  double scale = 1.0;          ///< not 0; degrees Celsius = number * scale + offset_c
  double offset_c = 0.0;       ///< -1000..1000
  int max_age_s = 600;         ///< 1..604800; an older file says nothing of now
};

/// With a block for each kind of device.
struct Config : DeviceConfigs {
  RpcConfig rpc;
  HttpConfig http;
  PathsConfig paths;
  ComputeConfig compute;
  LogConfig log;
  StoreConfig store;
  MetricsConfig metrics;
  std::vector<ObjectiveConfig> objectives;  ///< none = nobody asks which one is on the microscope
  TemperatureConfig temperature;
};

}  // namespace fvd
