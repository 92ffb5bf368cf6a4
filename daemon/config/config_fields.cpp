/// The keys of the configuration file: names, ranges, meanings.

#include "daemon/config/config_file.hpp"

namespace fvd {

namespace {

constexpr std::size_t kMaxPath = 4096;
constexpr std::size_t kMaxName = 255;
constexpr NumberRange kStageRangeUm{-1e6, 1e6};

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

void describe(CameraConfig& camera, Fields& fields) {
  fields.choice("driver", camera.driver, {"aravis", "replay"},
                "aravis = GigE Vision or USB3 Vision, replay = a folder");
  fields.text("address", camera.address, kMaxName, "IP address, or vendor-model-serial");
  fields.integer("packet_size_bytes", camera.packet_size_bytes, {0, 16000},
                 "GevSCPSPacketSize; 0 = the largest that comes through, never above the MTU of the interface");
  fields.integer("packet_delay_ns", camera.packet_delay_ns, {0, 1000000}, "GevSCPD; 0 = leave it as it is");
  fields.boolean("packet_socket", camera.packet_socket, "receive through AF_PACKET where CAP_NET_RAW allows");
  fields.integer("stream_priority", camera.stream_priority, {0, 99},
                 "real-time priority of the thread that receives frames; 0 = none");
  fields.choice("usb_mode", camera.usb_mode, {"sync", "async"}, "USB3 Vision: how frames are asked for");
  fields.integer("frame_margin_ms", camera.frame_margin_ms, {10, 10000},
                 "added to exposure and readout before a frame counts as missing");
  auto offset_us = camera.time_offset.count();
  fields.integer("time_offset_us", offset_us, {-1000000, 1000000},
                 "continuous scans: stage's clock minus camera's, as two scans in opposite directions tell");
  camera.time_offset = std::chrono::microseconds(offset_us);
  fields.boolean("simulated", camera.simulated, "stamped into every result");
  path(fields, "replay_dir", camera.replay_dir, "driver replay: folder of recorded slices");
}

void describe(StageConfig& stage, Fields& fields) {
  fields.choice("driver", stage.driver, {"modbus", "replay"},
                "modbus = a drive by its profile, replay = beside a replay camera");
  path(fields, "profile", stage.profile, "driver modbus: drive profile, a JSON file");
  fields.choice("transport", stage.transport, {"tcp", "rtu"}, "how the drive is reached");
  fields.text("address", stage.address, kMaxName, "tcp: host");
  fields.integer("port", stage.port, {1, 65535}, "tcp: port");
  fields.text("serial_device", stage.serial_device, kMaxName, "rtu: the port, best by its name in /dev/serial/by-id");
  fields.integer("serial_baud", stage.serial_baud, {9600, 921600}, "rtu: 9600, 19200, ... 921600");
  fields.choice("serial_parity", stage.serial_parity, {"none", "even", "odd"}, "rtu: parity");
  fields.integer("serial_stop_bits", stage.serial_stop_bits, {1, 2}, "rtu: stop bits");
  auto quiet_ms = stage.quiet.count();
  fields.integer("quiet_ms", quiet_ms, {1, 10000},
                 "rtu: silence on the line that must follow a doubtful answer; at least the drive's slowest reply");
  stage.quiet = std::chrono::milliseconds(quiet_ms);
  fields.integer("unit", stage.unit, {1, 247}, "Modbus unit id");
  auto timeout_ms = stage.response_timeout.count();
  fields.integer("response_timeout_ms", timeout_ms, {10, 10000}, "longest wait for the drive's answer");
  stage.response_timeout = std::chrono::milliseconds(timeout_ms);
  fields.number("min_um", stage.min.value, kStageRangeUm, "lowest position allowed, take-up included");
  fields.number("max_um", stage.max.value, kStageRangeUm, "highest position allowed");
  fields.number("take_up_um", stage.take_up.value, {0.0, 10000.0},
                "overshoot below the first slice that loads the backlash; at least 3 x backlash");
  fields.number("speed_um_per_s", stage.speed_um_per_s, positive(1e6), "speed of moves");
  fields.number("acceleration_um_per_s2", stage.acceleration_um_per_s2, positive(1e9), "acceleration of moves");
  fields.boolean("simulated", stage.simulated, "stamped into every result");
  fields.number("replay_start_um", stage.replay_start_um, kStageRangeUm, "driver replay: z of the first slice");
  fields.number("replay_step_um", stage.replay_step_um, positive(1e6), "driver replay: distance of slices");
  path(fields, "replay_z_file", stage.replay_z_file, "driver replay: z of each slice, in place of start and step");
  fields.choice("replay_z_unit", stage.replay_z_unit, {"um", "mm", "m"}, "driver replay: unit of that file");
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
  fields.group("camera", "the camera", [&](Fields& in) { describe(config.camera, in); });
  fields.group("stage", "the Z stage", [&](Fields& in) { describe(config.stage, in); });
  fields.group("paths", "folders", [&](Fields& in) { describe(config.paths, in); });
  fields.group("compute", "resources of the computation", [&](Fields& in) { describe(config.compute, in); });
  fields.group("log", "logging", [&](Fields& in) {
    in.choice("level", config.log.level, {"trace", "debug", "info", "warn", "error"}, "least severe level logged");
  });
}

}  // namespace fvd
