#include "sim/plant.hpp"

namespace fvd::sim {

Plant::Plant(const PlantOptions& options)
    : options_(options),
      axis_(options.axis),
      world_(options.world, axis_),
      drive_(axis_),
      camera_address_(options.camera_address == "auto" ? free_camera_address() : options.camera_address),
      stage_port_(options.stage_port) {
  plug_camera();
  plug_stage();
}

void Plant::plug_camera() {
  camera_ = std::make_unique<GigeCameraServer>(
      world_, GigeCameraOptions{.address = camera_address_, .seed = options_.world.seed});
}

void Plant::plug_stage() {
  stage_ = std::make_unique<ModbusTcpServer>(drive_,
                                             ModbusTcpOptions{.address = options_.stage_address, .port = stage_port_});
  stage_port_ = stage_->port();
}

}  // namespace fvd::sim
