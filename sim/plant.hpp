#pragma once

/// The whole simulated microscope: one world, its camera on GigE Vision, its stage on Modbus TCP.

#include <memory>
#include <string>

#include "sim/axis_model.hpp"
#include "sim/az_drive.hpp"
#include "sim/gige_camera_server.hpp"
#include "sim/modbus_tcp_server.hpp"
#include "sim/sim_world.hpp"
#include "sim/world_parameters.hpp"

namespace fvd::sim {

struct PlantOptions {
  WorldParameters world;
  AxisParameters axis;
  std::string camera_address = "auto";  ///< "auto" = a free loopback address
  std::string stage_address = "127.0.0.1";
  int stage_port = 0;  ///< 0 = any free port
};

/// Camera and drive can be taken away and brought back at the same address: unplugged cables in tests.
/// context: one thread.
class Plant {
 public:
  explicit Plant(const PlantOptions& options);

  [[nodiscard]] const std::string& camera_address() const { return camera_address_; }
  [[nodiscard]] int stage_port() const { return stage_port_; }
  [[nodiscard]] GigeCameraServer& camera() { return *camera_; }
  [[nodiscard]] ModbusTcpServer& stage() { return *stage_; }
  [[nodiscard]] AzDrive& drive() { return drive_; }
  [[nodiscard]] const SimWorld& world() const { return world_; }
  [[nodiscard]] AxisModel& axis() { return axis_; }

  void unplug_camera() { camera_.reset(); }
  void plug_camera();
  void unplug_stage() { stage_.reset(); }
  void plug_stage();

 private:
  PlantOptions options_;
  AxisModel axis_;
  SimWorld world_;
  AzDrive drive_;
  std::string camera_address_;
  int stage_port_;
  std::unique_ptr<GigeCameraServer> camera_;
  std::unique_ptr<ModbusTcpServer> stage_;
};

}  // namespace fvd::sim
