/// What the range of a single key cannot say: values that must fit together, files that must be there.

#include <algorithm>
#include <initializer_list>
#include <optional>
#include <sstream>
#include <string_view>
#include <utility>

#include <sys/un.h>

#include "core/base/error.hpp"
#include "daemon/access/address_range.hpp"
#include "daemon/access/token_file.hpp"
#include "daemon/config/config_file.hpp"
#include "drivers/common/network_address.hpp"
#include "drivers/registry/driver_table.hpp"

namespace fvd {

namespace {

namespace fs = std::filesystem;

std::string text(double value) {
  std::ostringstream out;
  out << value;
  return out.str();
}

/// While the socket is made its name is longer by one.
constexpr std::size_t kLongestSocketPath = sizeof sockaddr_un::sun_path - 2;

bool is_host_name(const std::string& name) {
  return !name.empty() && std::all_of(name.begin(), name.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' || c == '-';
  });
}

/// True if a listener at the one address has the other too: "::" is of both families.
bool has_too(const AddressBytes& every, const AddressBytes& other) {
  static const AddressRange kIpv4 = AddressRange::parse("0.0.0.0/0").value();
  return every == address_bytes("::") || (every == address_bytes("0.0.0.0") && kIpv4.contains(other));
}

/// With its mark, of an address like fe80::1%eth0; two links may have the same address.
std::string_view zone_of(std::string_view address) {
  return address.substr(std::min(address.find('%'), address.size()));
}

/// True if two listeners cannot have their ports at a time. Absent: there is no listener; 0 is any that is free.
bool are_one_port(const std::string& address, std::optional<int> port, const std::string& other_address,
                  std::optional<int> other_port) {
  if (port.value_or(0) == 0 || port != other_port) return false;
  const auto bytes = address_bytes(address);
  const auto other_bytes = address_bytes(other_address);
  if (!bytes || !other_bytes) return false;
  const bool are_same = bytes == other_bytes && zone_of(address) == zone_of(other_address);
  return are_same || has_too(*bytes, *other_bytes) || has_too(*other_bytes, *bytes);
}

/// Empty if the folder can be listed.
std::string folder_problem(const fs::path& folder) {
  std::error_code error;
  const fs::directory_iterator entries(folder, error);
  return error ? "cannot list folder '" + folder.string() + "': " + error.message() : "";
}

/// Collects problems. What rests on a value that was refused when it was read is not judged: its default stands there.
class ConfigCheck {
 public:
  ConfigCheck(const Config& config, const Problems& read) : config_(config), read_(read) {}

  Problems run() {
    check_rpc(config_.rpc);
    check_http(config_.http);
    check_listener("/metrics/address", config_.metrics.address);
    for (Problem& problem : check_devices(config_, read_)) report_if(true, problem.pointer, {}, problem.message);
    check_travel(config_.stage);
    const std::string& camera_driver = config_.camera.driver;
    const std::string& stage_driver = config_.stage.driver;
    report_if((camera_driver == "replay") != (stage_driver == "replay"), "/stage/driver", {"/camera/driver"},
              "'" + stage_driver + "' does not go with camera driver '" + camera_driver +
                  "': recorded slices need both to be replay");
    check_paths(config_.paths);
    check_objectives();
    report_if(config_.temperature.scale == 0.0, "/temperature/scale", {},
              "0 makes every number the same temperature; expected e.g. 0.001 for millidegrees");
    return std::move(found_);
  }

 private:
  [[nodiscard]] bool judged(std::string_view pointer) const { return !is_reported(read_, pointer); }

  /// others: what the rule rests on beside the value at the pointer.
  void report_if(bool wrong, std::string_view pointer, std::initializer_list<std::string_view> others,
                 std::string message) {
    if (!wrong || !judged(pointer)) return;
    if (!std::all_of(others.begin(), others.end(), [this](std::string_view other) { return judged(other); })) return;
    found_.push_back({std::string(pointer), std::move(message)});
  }

  void check_listener(std::string_view pointer, const std::string& address) {
    const std::string problem = why_no_listener(address);
    report_if(!problem.empty(), pointer, {}, problem);
  }

  void check_rpc(const RpcConfig& rpc) {
    check_listener("/rpc/address", rpc.address);
    const auto address = address_bytes(rpc.address);
    report_if(
        why_no_listener(rpc.address).empty() && address && !is_loopback(*address) && rpc.access.allow.empty() &&
            rpc.access.token_file.empty(),
        "/rpc/address", {"/rpc/allow", "/rpc/token_file"},
        "'" + rpc.address +
            "' is reached from the network, and nothing says who may move the stage from there; give /rpc/allow or "
            "/rpc/token_file, or listen on 127.0.0.1");
    check_allowed(rpc.access);
    check_tokens(rpc.access);
    const fs::path socket = rpc.socket.empty() ? config_.paths.runtime_dir / "fvd.sock" : rpc.socket;
    report_if(socket.string().size() > kLongestSocketPath, rpc.socket.empty() ? "/paths/runtime_dir" : "/rpc/socket",
              {},
              "'" + socket.string() + "' is too long for a socket, which may have " +
                  std::to_string(kLongestSocketPath) + " characters; give a shorter /rpc/socket");
  }

  void check_http(const HttpConfig& http) {
    check_listener("/http/address", http.address);
    const auto address = address_bytes(http.address);
    report_if(http.port && address && !is_loopback(*address) && config_.rpc.access.token_file.empty(), "/http/address",
              {"/http/port", "/rpc/token_file"},
              "'" + http.address +
                  "' is reached from the network, where a token alone says who somebody is; give /rpc/token_file, or "
                  "listen on 127.0.0.1");
    const RpcConfig& rpc = config_.rpc;
    const MetricsConfig& metrics = config_.metrics;
    report_if(are_one_port(http.address, http.port, rpc.address, rpc.port), "/http/port",
              {"/rpc/port", "/http/address", "/rpc/address"},
              std::to_string(rpc.port) + " is /rpc/port, which speaks no HTTP; give another");
    report_if(are_one_port(metrics.address, metrics.port, rpc.address, rpc.port), "/metrics/port",
              {"/rpc/port", "/metrics/address", "/rpc/address"},
              std::to_string(rpc.port) + " is /rpc/port, which gives no metrics; give another");
    report_if(are_one_port(metrics.address, metrics.port, http.address, http.port), "/metrics/port",
              {"/http/port", "/metrics/address", "/http/address"},
              std::to_string(http.port.value_or(0)) + " is /http/port, which gives no metrics; give another");
    for (std::size_t i = 0; i < http.hosts.size(); ++i) {
      report_if(
          !is_host_name(http.hosts[i].name), "/http/hosts/" + std::to_string(i) + "/name", {},
          "'" + http.hosts[i].name + "' is no name; expected e.g. fvd.line3.example, without scheme, port and path");
    }
  }

  void check_allowed(const AccessConfig& access) {
    std::vector<std::optional<AddressRange>> ranges;
    for (std::size_t i = 0; i < access.allow.size(); ++i) {
      const std::string pointer = "/rpc/allow/" + std::to_string(i) + "/address";
      const auto range = AddressRange::parse(access.allow[i].address);
      report_if(!range, pointer, {},
                "'" + access.allow[i].address +
                    "' is no address and no range; expected e.g. 192.168.1.10, or 192.168.1.0/24 with zeros behind the "
                    "prefix");
      report_if(range && std::find(ranges.begin(), ranges.end(), range) != ranges.end(), pointer, {},
                "'" + access.allow[i].address + "' stands there already: which role does it have?");
      const Role role = access.allow[i].role;
      report_if(
          range && range->is_everybody() && role > Role::kOperate, pointer,
          {"/rpc/allow/" + std::to_string(i) + "/role"},
          "'" + access.allow[i].address + "' is everybody who reaches the port, and " + std::string(role_name(role)) +
              " changes recipes or constants; name the addresses that may, or give them tokens (/rpc/token_file)");
      ranges.push_back(range);
    }
  }

  void check_tokens(const AccessConfig& access) {
    if (access.token_file.empty()) return;
    try {
      (void)read_credentials(access.token_file);
    } catch (const Error& error) {
      report_if(true, "/rpc/token_file", {}, error.what());
    }
  }

  void check_travel(const StageConfig& stage) {
    const bool in_order = stage.min < stage.max;
    report_if(!in_order, "/stage/min_um", {"/stage/max_um"},
              text(stage.min.value) + " is not below /stage/max_um, " + text(stage.max.value));
    report_if(in_order && stage.take_up >= stage.max - stage.min, "/stage/take_up_um",
              {"/stage/min_um", "/stage/max_um"},
              text(stage.take_up.value) + " leaves no room between min_um and max_um, " +
                  text((stage.max - stage.min).value) + " apart");
  }

  void check_paths(const PathsConfig& paths) {
    report_if(paths.state_dir.empty(), "/paths/state_dir", {}, "is empty; expected a folder");
    report_if(paths.runtime_dir.empty(), "/paths/runtime_dir", {}, "is empty; expected a folder");
    const std::string problem = folder_problem(paths.recipe_dir);
    report_if(!problem.empty(), "/paths/recipe_dir", {}, problem);
  }

  void check_objectives() {
    for (std::size_t i = 0; i < config_.objectives.size(); ++i) {
      check_name(i);
      check_soft_limits(config_.objectives[i], "/objectives/" + std::to_string(i));
    }
  }

  void check_name(std::size_t index) {
    const std::string& name = config_.objectives[index].name;
    const std::string pointer = "/objectives/" + std::to_string(index) + "/name";
    const bool plain = std::all_of(name.begin(), name.end(), [](char c) { return c >= ' ' && c <= '~'; });
    report_if(name.empty() || !plain, pointer, {}, "'" + name + "' is no name; expected printable ASCII characters");
    for (std::size_t other = 0; other < index; ++other) {
      if (config_.objectives[other].name != name) continue;
      report_if(true, pointer, {}, "'" + name + "' is the name of /objectives/" + std::to_string(other) + " too");
      return;
    }
  }

  void check_soft_limits(const ObjectiveConfig& objective, const std::string& place) {
    const StageConfig& stage = config_.stage;
    const std::string min_um = place + "/min_um";
    const std::string max_um = place + "/max_um";
    const std::string range = text(stage.min.value) + ".." + text(stage.max.value);
    const auto outside = [&stage](std::optional<double> z_um) {
      return z_um && (*z_um < stage.min.value || *z_um > stage.max.value);
    };
    for (const auto& [pointer, z_um] : {std::pair(min_um, objective.min_um), std::pair(max_um, objective.max_um)}) {
      report_if(outside(z_um), pointer, {"/stage/min_um", "/stage/max_um"},
                text(z_um.value_or(0.0)) + " is outside the stage's limits, " + range + " um");
    }
    if (outside(objective.min_um) || outside(objective.max_um)) return;
    const double lowest = objective.min_um.value_or(stage.min.value);
    const double highest = objective.max_um.value_or(stage.max.value);
    const bool in_order = lowest < highest;
    const std::string& of_lower = objective.min_um ? min_um : max_um;
    report_if(
        !in_order, of_lower, {max_um, "/stage/min_um", "/stage/max_um"},
        "the objective's " + text(lowest) + ".." + text(highest) + " um is no range: min_um must be below max_um");
    report_if(in_order && stage.take_up.value >= highest - lowest, of_lower,
              {max_um, "/stage/take_up_um", "/stage/min_um", "/stage/max_um"},
              "/stage/take_up_um of " + text(stage.take_up.value) + " leaves no room in the objective's " +
                  text(lowest) + ".." + text(highest) + " um");
  }

  const Config& config_;
  const Problems& read_;
  Problems found_;
};

}  // namespace

Problems check_config(const Config& config, const Problems& read) { return ConfigCheck(config, read).run(); }

}  // namespace fvd
