#pragma once

/// The whole simulated microscope: one world, its camera on GigE Vision, its stage on Modbus TCP or RTU, or on GCS.

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "sim/axis/axis_model.hpp"
#include "sim/axis/motion_log.hpp"
#include "sim/camera/gige_camera_server.hpp"
#include "sim/camera/line_trigger.hpp"
#include "sim/drives/drive_kinds.hpp"
#include "sim/gcs/gcs_server.hpp"
#include "sim/modbus/fault_script.hpp"
#include "sim/modbus/modbus_rtu_server.hpp"
#include "sim/modbus/modbus_tcp_server.hpp"
#include "sim/world/sim_world.hpp"
#include "sim/world/world_parameters.hpp"

namespace fvd::sim {

struct PlantOptions {
  WorldParameters world;
  AxisParameters axis;
  std::string camera_address = "auto";  ///< "auto" = a free loopback address
  std::string camera_serial = "SIM01";  ///< at most 15 characters, as the name
  std::string camera_name{};            ///< user-defined
  bool camera_discoverable = false;     ///< found by broadcasts on loopback
  int camera_width_increment = 1;       ///< pixels
  bool camera_chunk_mode = false;       ///< described, see GigeCameraOptions
  std::string stage_address = "127.0.0.1";
  int stage_port = 0;  ///< 0 = any free port
  DriveKind drive = DriveKind::kAz;
  bool low_word_first = false;        ///< of 32-bit values in the drive's registers, Modbus only
  bool gcs = false;                   ///< a controller that speaks GCS in place of a drive; no faults, no line timing
  std::filesystem::path stage_pty{};  ///< if given, a serial line on a pseudo-terminal linked here instead of TCP
  LineTiming line_timing{};           ///< timing of that line, Modbus RTU only
  std::vector<FaultStep> faults{};    ///< faults of the stage's line and drive, Modbus only
  std::vector<CameraFaultStep> camera_faults{};
  std::filesystem::path motion_log{};  ///< if given, the stage's commands and motions are written here
};

/// Camera and drive can be taken away and brought back at the same address: unplugged cables in tests.
/// context: one thread.
class Plant {
 public:
  /// Throws Error kBadConfig for what cannot be served or cannot happen.
  explicit Plant(const PlantOptions& options);

  [[nodiscard]] const std::string& camera_address() const { return camera_address_; }
  [[nodiscard]] int stage_port() const { return stage_port_; }  ///< PlantOptions::stage_port if the stage is serial
  [[nodiscard]] GigeCameraServer& camera() { return *camera_; }
  [[nodiscard]] ModbusTcpServer& stage() { return *stage_; }                ///< only without stage_pty and gcs
  [[nodiscard]] ModbusRtuServer& serial_stage() { return *serial_stage_; }  ///< only with stage_pty, without gcs
  [[nodiscard]] std::uint64_t stage_requests() const;                       ///< since the stage was plugged in last
  [[nodiscard]] SimDrive& drive() { return *drive_; }                       ///< only without gcs
  [[nodiscard]] FaultScript& faults() { return faults_; }
  [[nodiscard]] const SimWorld& world() const { return world_; }
  [[nodiscard]] AxisModel& axis() { return axis_; }

  void unplug_camera();
  void plug_camera();
  void unplug_stage();
  void plug_stage();

 private:
  PlantOptions options_;
  AxisModel axis_;
  std::unique_ptr<MotionLog> motion_log_;
  SimWorld world_;
  std::unique_ptr<SimDrive> drive_;                // or
  std::unique_ptr<GcsController> gcs_controller_;  // this
  FaultScript faults_;
  std::string camera_address_;
  int stage_port_;
  std::unique_ptr<GigeCameraServer> camera_;
  std::unique_ptr<LineTrigger> wire_;  // from the drive to the camera
  std::unique_ptr<ModbusTcpServer> stage_;
  std::unique_ptr<ModbusRtuServer> serial_stage_;
  std::unique_ptr<GcsServer> gcs_stage_;
};

}  // namespace fvd::sim
