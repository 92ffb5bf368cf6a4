#include "drivers/registry/driver_keys.hpp"

#include <algorithm>
#include <filesystem>
#include <iterator>

#include "core/base/error.hpp"
#include "drivers/common/text_line.hpp"
#include "drivers/modbus/drive_profile.hpp"
#include "drivers/modbus/modbus_transport.hpp"

namespace fvd {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxPathBytes = 4096;
constexpr std::size_t kMaxNameBytes = 255;
constexpr std::size_t kMaxAxisNameBytes = 16;
constexpr NumberRange kStageRange_um{-1e6, 1e6};

void path(Fields& fields, std::string_view name, fs::path& value, std::string_view meaning) {
  std::string text = value.string();
  fields.text(name, text, kMaxPathBytes, meaning);
  value = text;
}

template <std::size_t kCount>
void check_baud(int baud, const int (&accepted)[kCount], Problems& problems) {
  if (std::find(std::begin(accepted), std::end(accepted), baud) != std::end(accepted)) return;
  std::string bauds;
  for (const int one : accepted) bauds += " " + std::to_string(one);
  problems.push_back({"/stage/serial_baud", std::to_string(baud) + " is not accepted; expected one of" + bauds});
}

/// transport: the word for the serial line of this protocol.
template <std::size_t kCount>
void check_line(const StageConfig& stage, const std::string& serial, const int (&bauds)[kCount], Problems& problems) {
  if (stage.transport == "tcp") {
    if (stage.address.empty()) {
      problems.push_back({"/stage/address", "is empty; expected the drive's host or IP address"});
    }
    return;
  }
  if (stage.transport != serial) {
    problems.push_back({"/stage/transport", "'" + stage.transport + "' does not go with driver '" + stage.driver +
                                                "'; expected tcp or " + serial});
    return;
  }
  if (stage.serial_device.empty()) {
    problems.push_back({"/stage/serial_device", "is empty; expected a serial port such as /dev/serial/by-id/..."});
  }
  check_baud(stage.serial_baud, bauds, problems);
}

}  // namespace

void describe_all_cameras(CameraConfig& camera, Fields& fields) {
  fields.integer("frame_margin_ms", camera.frame_margin_ms, {10, 10000},
                 "added to exposure and readout before a frame counts as missing");
  auto offset_us = camera.time_offset.count();
  fields.integer("time_offset_us", offset_us, {-1000000, 1000000},
                 "continuous scans: stage's clock minus camera's, as two scans in opposite directions tell");
  camera.time_offset = std::chrono::microseconds(offset_us);
  fields.boolean("simulated", camera.simulated, "stamped into every result");
}

void describe_aravis(CameraConfig& camera, Fields& fields) {
  fields.text("address", camera.address, kMaxNameBytes,
              "IP address, serial number, MAC, user-defined name, or vendor-model-serial; only an IP needs no search");
  fields.text("serial", camera.serial, kMaxNameBytes,
              "serial number that the camera must have, another one is refused; empty = any");
  fields.text(
      "search_address", camera.search_address, kMaxNameBytes,
      "where a camera without an IP is searched: a broadcast address such as 192.168.1.255; empty = all networks");
  fields.integer("silence_ms", camera.silence_ms, {50, 60000},
                 "a camera that answers nothing for so long is lost; a frame that is due has its own deadline");
  fields.integer("packet_size_bytes", camera.packet_size_bytes, {0, 16000},
                 "GevSCPSPacketSize; 0 = the largest that comes through, never above the MTU of the interface");
  fields.integer("packet_delay_ns", camera.packet_delay_ns, {0, 1000000}, "GevSCPD; 0 = leave it as it is");
  fields.boolean("packet_socket", camera.packet_socket, "receive through AF_PACKET where CAP_NET_RAW allows");
  fields.integer("stream_priority", camera.stream_priority, {0, 99},
                 "real-time priority of the thread that receives frames; 0 = none");
  fields.choice("usb_mode", camera.usb_mode, {"sync", "async"}, "USB3 Vision: how frames are asked for");
}

void describe_replay(CameraConfig& camera, Fields& fields) {
  path(fields, "replay_dir", camera.replay_dir, "driver replay: folder of recorded slices");
}

void describe_all_stages(StageConfig& stage, Fields& fields) {
  fields.number("min_um", stage.min.value, kStageRange_um, "lowest position allowed, take-up included");
  fields.number("max_um", stage.max.value, kStageRange_um, "highest position allowed");
  fields.number("take_up_um", stage.take_up.value, {0.0, 10000.0},
                "overshoot below the first slice that loads the backlash; at least 3 x backlash");
  fields.number("speed_um_per_s", stage.speed_um_per_s, positive(1e6), "speed of moves");
  fields.number("acceleration_um_per_s2", stage.acceleration_um_per_s2, positive(1e9), "acceleration of moves");
  fields.boolean("simulated", stage.simulated, "stamped into every result");
  fields.choice("transport", stage.transport, {"tcp", "rtu", "serial"},
                "how the drive is reached; rtu = Modbus on a serial line, serial = driver gcs on one");
  fields.text("address", stage.address, kMaxNameBytes, "tcp: host");
  fields.integer("port", stage.port, {1, 65535}, "tcp: port; Modbus 502, controllers of Physik Instrumente 50000");
  fields.text("serial_device", stage.serial_device, kMaxNameBytes,
              "rtu, serial: the port, best by its name in /dev/serial/by-id");
  fields.integer("serial_baud", stage.serial_baud, {9600, 921600}, "rtu, serial: 9600, 19200, ... 921600");
  auto timeout_ms = stage.response_timeout.count();
  fields.integer("response_timeout_ms", timeout_ms, {10, 10000}, "longest wait for the drive's answer");
  stage.response_timeout = std::chrono::milliseconds(timeout_ms);
}

void describe_modbus(StageConfig& stage, Fields& fields) {
  path(fields, "profile", stage.profile, "driver modbus: drive profile, a JSON file");
  fields.choice("serial_parity", stage.serial_parity, {"none", "even", "odd"}, "rtu: parity");
  fields.integer("serial_stop_bits", stage.serial_stop_bits, {1, 2}, "rtu: stop bits");
  auto quiet_ms = stage.quiet.count();
  fields.integer("quiet_ms", quiet_ms, {1, 10000},
                 "rtu: silence on the line that must follow a doubtful answer; at least the drive's slowest reply");
  stage.quiet = std::chrono::milliseconds(quiet_ms);
  fields.integer("unit", stage.unit, {1, 247}, "Modbus unit id");
}

void describe_gcs(StageConfig& stage, Fields& fields) {
  fields.text("gcs_axis", stage.gcs_axis, kMaxAxisNameBytes, "driver gcs: the axis as the controller calls it");
  fields.choice("gcs_feedback", stage.gcs_feedback, {"motor_encoder", "linear_scale"},
                "driver gcs: where the measured position comes from");
}

void describe_replay(StageConfig& stage, Fields& fields) {
  fields.number("replay_start_um", stage.replay_start_um, kStageRange_um, "driver replay: z of the first slice");
  fields.number("replay_step_um", stage.replay_step_um, positive(1e6), "driver replay: distance of slices");
  path(fields, "replay_z_file", stage.replay_z_file, "driver replay: z of each slice, in place of start and step");
  fields.choice("replay_z_unit", stage.replay_z_unit, {"um", "mm", "m"}, "driver replay: unit of that file");
}

void check_aravis(const CameraConfig& camera, Problems& problems) {
  if (!camera.address.empty()) return;
  problems.push_back({"/camera/address",
                      "is empty; expected the camera's IP address, serial number, MAC, user-defined "
                      "name or vendor-model-serial"});
}

void check_replay(const CameraConfig& camera, Problems& problems) {
  std::error_code error;
  const fs::directory_iterator entries(camera.replay_dir, error);
  if (!error) return;
  problems.push_back(
      {"/camera/replay_dir", "cannot list folder '" + camera.replay_dir.string() + "': " + error.message()});
}

void check_modbus(const StageConfig& stage, Problems& problems) {
  check_line(stage, "rtu", kModbusBauds, problems);
  std::error_code error;
  if (!fs::is_regular_file(stage.profile, error)) {
    problems.push_back({"/stage/profile", "there is no file '" + stage.profile.string() +
                                              "'; expected a drive profile such as drives/oriental-az.json"});
    return;
  }
  try {
    (void)load_drive_profile(stage.profile);
  } catch (const Error& refused) {
    problems.push_back({"/stage/profile", refused.what()});
  }
}

void check_gcs(const StageConfig& stage, Problems& problems) {
  check_line(stage, "serial", kTextLineBauds, problems);
  if (!stage.gcs_axis.empty() && stage.gcs_axis.find_first_of(" \n\r=") == std::string::npos) return;
  problems.push_back(
      {"/stage/gcs_axis", "'" + stage.gcs_axis + "' is no name of an axis; expected one such as 1 or A"});
}

void check_replay(const StageConfig& /*stage*/, Problems& /*problems*/) {}

}  // namespace fvd
