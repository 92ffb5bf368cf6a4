/// The keys of the configuration file: names, ranges, meanings.

#include "daemon/config/config_file.hpp"
#include "drivers/registry/driver_table.hpp"

namespace fvd {

namespace {

constexpr std::size_t kMaxPath = 4096;
constexpr std::size_t kMaxName = 255;

void path(Fields& fields, std::string_view name, std::filesystem::path& value, std::string_view meaning) {
  std::string text = value.string();
  fields.text(name, text, kMaxPath, meaning);
  value = text;
}

void describe(RpcConfig& rpc, Fields& fields) {
  fields.text("address", rpc.address, kMaxName, "numeric IPv4 or IPv6 address to listen on");
  fields.integer("port", rpc.port, {0, 65535}, "TCP port; 0 = any free one, written to <runtime_dir>/rpc.json");
  fields.integer("max_connections", rpc.max_connections, {1, 1000}, "one more gets an error line and is closed");
  fields.integer("idle_timeout_s", rpc.idle_timeout_s, {1, 86400}, "a connection silent for so long is closed");
}

void describe(PathsConfig& paths, Fields& fields) {
  path(fields, "state_dir", paths.state_dir, "database and results; relative to the current directory");
  path(fields, "runtime_dir", paths.runtime_dir, "rpc.json; relative to the current directory");
  path(fields, "recipe_dir", paths.recipe_dir, "recipes; relative to the configuration file");
}

void describe(ComputeConfig& compute, Fields& fields) {
  fields.integer("threads", compute.threads, {0, 256}, "threads of the computation, 0 = one a core");
  fields.integer("memory_budget_mib", compute.memory_budget_mib, {16, 1048576}, "a job that needs more is refused");
  fields.integer("queue_slices", compute.queue_slices, {1, 64}, "slices between camera and computation");
}

}  // namespace

void describe(Config& config, Fields& fields) {
  fields.group("rpc", "where clients connect", [&](Fields& in) { describe(config.rpc, in); });
  describe(static_cast<DeviceConfigs&>(config), fields);
  fields.group("paths", "folders", [&](Fields& in) { describe(config.paths, in); });
  fields.group("compute", "resources of the computation", [&](Fields& in) { describe(config.compute, in); });
  fields.group("log", "logging", [&](Fields& in) {
    in.choice("level", config.log.level, {"trace", "debug", "info", "warn", "error"}, "least severe level logged");
  });
}

}  // namespace fvd
