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

void describe_role(Fields& fields, std::string_view name, Role& role, std::string_view meaning) {
  std::vector<std::string> names;
  for (const Role given : kGivenRoles) names.emplace_back(role_name(given));
  std::string text(role_name(role));
  fields.choice(name, text, names, meaning);
  role = role_from_name(text).value_or(role);
}

void describe(AccessConfig& access, Fields& fields) {
  constexpr IntegerRange kRules{0, 100};
  fields.list("allow", access.allow, kRules, "who may connect to the TCP port; of several that fit the narrowest holds",
              [](Fields& in, AddressRule& rule) {
                in.text("address", rule.address, kMaxName, "an address, or a range as 192.168.1.0/24");
                in.require("address");
                describe_role(in, "role", rule.role, "what it may");
                in.require("role");
              });
  describe_role(fields, "loopback_role", access.loopback_role,
                "of 127.0.0.1 and ::1 where allow does not name them; every process of this machine can connect there");
  fields.list("groups", access.groups, kRules, "whose members may what by the unix socket; root may all",
              [](Fields& in, GroupRule& rule) {
                in.text("group", rule.group, kMaxName, "of the system");
                in.require("group");
                describe_role(in, "role", rule.role, "what its members may");
                in.require("role");
              });
  path(fields, "token_file", access.token_file,
       "lines 'name role hash' as fvdctl token new prints them; relative to the configuration file; empty = none");
}

void describe(RpcConfig& rpc, Fields& fields) {
  fields.text("address", rpc.address, kMaxName, "numeric IPv4 or IPv6 address to listen on");
  fields.integer("port", rpc.port, {0, 65535}, "TCP port; 0 = any free one, written to <runtime_dir>/rpc.json");
  fields.integer("max_connections", rpc.max_connections, {2, 1000},
                 "one more gets an error line and is closed; one is kept for who has control");
  fields.integer("idle_timeout_s", rpc.idle_timeout_s, {1, 86400}, "a connection silent for so long is closed");
  fields.integer("repeat_window_s", rpc.repeat_window_s, {1, 31536000},
                 "a sequence number whose job ended longer ago is refused, not answered with the old job");
  fields.integer("fifo_results", rpc.fifo_results, {1, 1000000},
                 "more results that wait to be acknowledged set overrun; none is dropped");
  fields.integer("first_request_s", rpc.first_request_s, {1, 86400},
                 "a connection that has made no valid request by then is closed");
  path(fields, "socket", rpc.socket, "unix socket for programs of this machine; empty = <runtime_dir>/fvd.sock");
  describe(rpc.access, fields);
}

void describe(HttpConfig& http, Fields& fields) {
  fields.text("address", http.address, kMaxName, "numeric IPv4 or IPv6 address to listen on");
  fields.optional("port", http.port, [](Fields& in, int& port) {
    in.integer("port", port, {0, 65535},
               "TCP port of the operator page and of POST /api/jsonrpc; 0 = any free one; absent = none");
  });
  fields.list(
      "hosts", http.hosts, {0, 20},
      "names by which clients may call it, as that of a reverse proxy; localhost and its own addresses need none",
      [](Fields& in, HttpHost& host) {
        in.text("name", host.name, kMaxName, "as in the URL, without scheme and port");
        in.require("name");
      });
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

void describe(StoreConfig& store, Fields& fields) {
  fields.integer("keep_days", store.keep_days, {0, 36500}, "acknowledged results go when they are older; 0 = never");
  fields.integer("keep_gib", store.keep_gib, {0, 1048576},
                 "the oldest acknowledged results go when all take more; 0 = never");
  fields.integer("keep_free_gib", store.keep_free_gib, {0, 1048576},
                 "likewise when the disk has less free; where it never has so much, all acknowledged results go, but "
                 "none where the whole disk is smaller; 0 = never");
}

void describe(ObjectiveConfig& objective, Fields& fields) {
  constexpr std::size_t kMaxObjective = 64;
  static constexpr NumberRange kZ_um{-1e6, 1e6};
  fields.text("name", objective.name, kMaxObjective, "that recipes and objective.confirm give; unique");
  fields.require("name");
  fields.number("na", objective.na, positive(1.7), "numerical aperture");
  fields.require("na");
  fields.number("magnification", objective.magnification, positive(1000.0), "as engraved");
  fields.require("magnification");
  fields.number("working_distance_mm", objective.working_distance_mm, positive(1000.0), "from its front to the focus");
  fields.require("working_distance_mm");
  fields.optional("min_um", objective.min_um, [](Fields& in, double& value) {
    in.number("min_um", value, kZ_um, "lowest z with this objective, take-up included; absent = the stage's");
  });
  fields.optional("max_um", objective.max_um, [](Fields& in, double& value) {
    in.number("max_um", value, kZ_um, "highest z with this objective; absent = the stage's");
  });
}

void describe(TemperatureConfig& temperature, Fields& fields) {
  path(fields, "file", temperature.file,
       "text file with one number, e.g. /sys/class/hwmon/hwmon0/temp1_input; read when a scan begins; empty = none");
  fields.number("scale", temperature.scale, {-1e3, 1e3}, "degrees Celsius per unit of the file; 0.001 = millidegrees");
  fields.number("offset_c", temperature.offset_c, {-1000.0, 1000.0}, "added to number * scale");
  fields.integer("max_age_s", temperature.max_age_s, {1, 604800},
                 "since the file was written; an older one counts as unknown; of sysfs none is old");
}

void describe(MetricsConfig& metrics, Fields& fields) {
  fields.text("address", metrics.address, kMaxName, "numeric IPv4 or IPv6 address to listen on");
  fields.optional("port", metrics.port, [](Fields& in, int& port) {
    in.integer("port", port, {0, 65535}, "TCP port of /metrics and /healthz; 0 = any free one; absent = none");
  });
}

}  // namespace

void describe(Config& config, Fields& fields) {
  fields.group("rpc", "where clients connect", [&](Fields& in) { describe(config.rpc, in); });
  fields.group("http", "JSON-RPC by HTTP for pages and other programs; without a token a caller may look at most",
               [&](Fields& in) { describe(config.http, in); });
  describe(static_cast<DeviceConfigs&>(config), fields);
  fields.group("paths", "folders", [&](Fields& in) { describe(config.paths, in); });
  fields.group("compute", "resources of the computation", [&](Fields& in) { describe(config.compute, in); });
  fields.group("log", "logging", [&](Fields& in) {
    in.choice("level", config.log.level, {"trace", "debug", "info", "warn", "error"}, "least severe level logged");
  });
  fields.group("store", "what is removed to make room; nothing unless a key says so, nothing that is not acknowledged",
               [&](Fields& in) { describe(config.store, in); });
  fields.group("metrics", "for Prometheus and other programs that watch the station, by HTTP; read only",
               [&](Fields& in) { describe(config.metrics, in); });
  fields.list("objectives", config.objectives, {0, 20},
              "objectives that can be on the microscope; a person confirms which one is there",
              [](Fields& in, ObjectiveConfig& objective) { describe(objective, in); });
  fields.group("temperature", "where the temperature is read that results tell",
               [&](Fields& in) { describe(config.temperature, in); });
}

}  // namespace fvd
