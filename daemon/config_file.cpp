#include "daemon/config_file.hpp"

#include <algorithm>
#include <sstream>

#include <nlohmann/json.hpp>

#include "config/field_reader.hpp"
#include "config/field_writer.hpp"
#include "config/strict_json.hpp"

namespace fvd {

namespace {

using nlohmann::json;

void path_field(Fields& fields, std::string_view name, std::filesystem::path& value, std::string_view meaning) {
  std::string text = value.string();
  fields.text(name, text, 4096, meaning);
  value = text;
}

void length_field(Fields& fields, std::string_view name, Micrometers& value, NumberRange range, std::string_view meaning) {
  fields.number(name, value.value, range, meaning);
}

void describe_camera(CameraConfig& camera, Fields& fields) {
  fields.choice("driver", camera.driver, {"aravis", "replay"}, "aravis = GigE Vision and USB3 Vision, replay = recorded slices");
  fields.text("address", camera.address, 253, "IP address of the camera, or vendor-model-serial");
  fields.integer("packet_size_bytes", camera.packet_size_bytes, {576, 16000}, "GigE packet size, not above the interface's MTU");
  fields.boolean("packet_socket", camera.packet_socket, "receive through AF_PACKET where permitted; off on loopback");
  fields.integer("frame_margin_ms", camera.frame_margin_ms, {10, 10000}, "added to exposure and transfer before a frame is missing");
  fields.boolean("simulated", camera.simulated, "mark every result as simulated");
  path_field(fields, "replay_dir", camera.replay_dir, "driver replay: folder of recorded slices");
}

void describe_stage(StageConfig& stage, Fields& fields) {
  fields.choice("driver", stage.driver, {"modbus", "replay"}, "modbus = a drive with a profile, replay = recorded slices");
  path_field(fields, "profile", stage.profile, "drive profile, a JSON file");
  fields.text("address", stage.address, 253, "host of the drive (Modbus TCP)");
  fields.integer("port", stage.port, {1, 65535}, "TCP port of the drive");
  fields.integer("unit", stage.unit, {0, 247}, "Modbus unit id");
  auto timeout_ms = stage.response_timeout.count();
  fields.integer("response_timeout_ms", timeout_ms, {10, 10000}, "for one Modbus transaction");
  stage.response_timeout = std::chrono::milliseconds(timeout_ms);
  length_field(fields, "min_um", stage.min, {-1e6, 1e6}, "lowest position allowed, take-up included");
  length_field(fields, "max_um", stage.max, {-1e6, 1e6}, "highest position allowed");
  length_field(fields, "take_up_um", stage.take_up, {0.0, 10000.0}, "overshoot below the first slice, at least three times the backlash");
  fields.number("speed_um_per_s", stage.speed_um_per_s, positive(1e6), "of moves");
  fields.number("acceleration_um_per_s2", stage.acceleration_um_per_s2, positive(1e8), "of moves");
  fields.boolean("simulated", stage.simulated, "mark every result as simulated");
  fields.number("replay_start_um", stage.replay_start_um, {-1e6, 1e6}, "driver replay: z of the first slice");
  fields.number("replay_step_um", stage.replay_step_um, positive(1e6), "driver replay: distance of slices");
  path_field(fields, "replay_z_file", stage.replay_z_file, "driver replay: z of each slice, in place of start and step");
  fields.choice("replay_z_unit", stage.replay_z_unit, {"um", "mm", "m"}, "driver replay: unit of that file");
}

std::filesystem::path beside(const std::filesystem::path& file, const std::filesystem::path& path) {
  return path.empty() || path.is_absolute() ? path : std::filesystem::absolute(file).parent_path() / path;
}

/// What no single key can tell.
void check_together(const Config& config, Problems& problems) {
  const auto report = [&problems](const char* pointer, const auto&... parts) {
    std::ostringstream message;
    (message << ... << parts);
    problems.push_back({pointer, message.str()});
  };
  if (config.stage.min >= config.stage.max) {
    report("/stage/min_um", config.stage.min.value, " must be below max_um = ", config.stage.max.value);
  } else if (config.stage.take_up >= config.stage.max - config.stage.min) {
    report("/stage/take_up_um", config.stage.take_up.value, " must be below the travel of ",
           (config.stage.max - config.stage.min).value, " um");
  }
  const bool replays = config.camera.driver == "replay";
  if (replays != (config.stage.driver == "replay")) {
    report("/stage/driver", "camera and stage are replayed together or not at all");
  }
  std::error_code error;
  if (replays) {
    if (!std::filesystem::is_directory(config.camera.replay_dir, error)) {
      report("/camera/replay_dir", "'", config.camera.replay_dir.string(), "' is not a folder");
    }
  } else {
    if (config.camera.address.empty()) report("/camera/address", "is empty; give the camera's IP address");
    if (!std::filesystem::is_regular_file(config.stage.profile, error)) {
      report("/stage/profile", "'", config.stage.profile.string(), "' is not a file");
    }
  }
  if (!std::filesystem::is_directory(config.paths.recipe_dir, error)) {
    report("/paths/recipe_dir", "'", config.paths.recipe_dir.string(), "' is not a folder");
  }
}

/// Applies "a.b=value" to the document; false with a problem if it cannot be.
void apply_override(json& document, const std::string& text, Problems& problems) {
  const auto equals = text.find('=');
  if (equals == std::string::npos || equals == 0) {
    problems.push_back({"", "--set '" + text + "' is not of the form group.key=value"});
    return;
  }
  std::string pointer = "/" + text.substr(0, equals);
  std::replace(pointer.begin(), pointer.end(), '.', '/');
  const std::string value = text.substr(equals + 1);
  // Only what JSON calls a number, a truth value or a list is that; everything else, an IP address too, is a text.
  const json parsed = json::parse(value, nullptr, false);
  const bool plain = parsed.is_discarded() || parsed.is_object() || parsed.is_null();
  try {
    document[json::json_pointer(pointer)] = plain ? json(value) : parsed;
  } catch (const json::exception&) {
    problems.push_back({"", "--set '" + text + "' names no key of an object"});
  }
}

}  // namespace

void describe(Config& config, Fields& fields) {
  fields.group("rpc", "the JSON-RPC listener", [&](Fields& group) {
    group.text("address", config.rpc.address, 64, "numeric address to listen on");
    group.integer("port", config.rpc.port, {0, 65535}, "TCP port, 0 = any free one, written to runtime_dir/rpc.json");
    group.integer("max_connections", config.rpc.max_connections, {1, 1000}, "clients at a time");
    group.integer("idle_timeout_s", config.rpc.idle_timeout_s, {1, 86400}, "a silent connection is closed after so long");
  });
  fields.group("camera", "the camera", [&](Fields& group) { describe_camera(config.camera, group); });
  fields.group("stage", "the Z stage", [&](Fields& group) { describe_stage(config.stage, group); });
  fields.group("paths", "folders", [&](Fields& group) {
    path_field(group, "state_dir", config.paths.state_dir, "database and results");
    path_field(group, "runtime_dir", config.paths.runtime_dir, "rpc.json with the address in use");
    path_field(group, "recipe_dir", config.paths.recipe_dir, "recipes, one JSON file each");
  });
  fields.group("compute", "the focus computation", [&](Fields& group) {
    group.integer("threads", config.compute.threads, {0, 256}, "0 = one a core");
    group.integer("memory_budget_mib", config.compute.memory_budget_mib, {16, 1048576}, "a job that needs more is refused");
    group.integer("queue_slices", config.compute.queue_slices, {1, 64}, "slices between camera and computation");
  });
  fields.group("log", "the log", [&](Fields& group) {
    group.choice("level", config.log.level, {"trace", "debug", "info", "warn", "error"}, "least severity that is logged");
  });
}

LoadedConfig load_config(const std::filesystem::path& file, const Overrides& overrides) {
  LoadedConfig loaded;
  std::optional<json> document;
  try {
    document = parse_strict_json(read_text_file(file), loaded.problems);
  } catch (const Error& error) {
    loaded.problems.push_back({"", error.what()});
  }
  if (!document) return loaded;
  for (const std::string& text : overrides) apply_override(*document, text, loaded.problems);
  FieldReader reader(*document, loaded.problems);
  describe(loaded.config, reader);
  reader.finish();
  loaded.config.stage.profile = beside(file, loaded.config.stage.profile);
  loaded.config.paths.recipe_dir = beside(file, loaded.config.paths.recipe_dir);
  loaded.config.camera.replay_dir = beside(file, loaded.config.camera.replay_dir);
  loaded.config.stage.replay_dir = loaded.config.camera.replay_dir;
  loaded.config.stage.replay_z_file = beside(file, loaded.config.stage.replay_z_file);
  loaded.config.paths.state_dir = std::filesystem::absolute(loaded.config.paths.state_dir);
  loaded.config.paths.runtime_dir = std::filesystem::absolute(loaded.config.paths.runtime_dir);
  check_together(loaded.config, loaded.problems);
  return loaded;
}

std::string config_text(Config config) {
  return fields_to_json([&config](Fields& fields) { describe(config, fields); }).dump(2) + "\n";
}

std::string config_schema_text() {
  Config defaults;
  return fields_to_schema([&defaults](Fields& fields) { describe(defaults, fields); }, "fvd configuration").dump(2) + "\n";
}

}  // namespace fvd
