#include "sim/plant/plant.hpp"

namespace fvd::sim {

Plant::Plant(const PlantOptions& options)
    : options_(options),
      axis_(options.axis),
      motion_log_(options.motion_log.empty() ? nullptr : std::make_unique<MotionLog>(axis_, options.motion_log)),
      world_(options.world, axis_),
      drive_(options.gcs ? nullptr : make_drive(options.drive, axis_)),
      gcs_controller_(options.gcs ? std::make_unique<GcsController>(axis_) : nullptr),
      faults_(options.faults),
      camera_address_(options.camera_address == "auto" ? free_camera_address() : options.camera_address),
      stage_port_(options.stage_port) {
  if (drive_ && options_.low_word_first) drive_->set_low_word_first();
  plug_camera();
  plug_stage();
}

void Plant::plug_camera() {
  camera_ =
      std::make_unique<GigeCameraServer>(world_, GigeCameraOptions{.address = camera_address_,
                                                                   .serial = options_.camera_serial,
                                                                   .name = options_.camera_name,
                                                                   .discoverable = options_.camera_discoverable,
                                                                   .width_increment = options_.camera_width_increment,
                                                                   .chunk_mode = options_.camera_chunk_mode,
                                                                   .seed = options_.world.seed});
  for (const CameraFaultStep& step : options_.camera_faults) camera_->faults().add(step);
  wire_ = std::make_unique<LineTrigger>(axis_, [this] { camera_->pulse_line(); });
}

void Plant::unplug_camera() {
  wire_.reset();
  camera_.reset();
}

void Plant::plug_stage() {
  if (gcs_controller_) {
    GcsServerOptions line{.address = options_.stage_address, .port = stage_port_};
    if (!options_.stage_pty.empty()) line.terminal_link = options_.stage_pty;
    gcs_stage_ = std::make_unique<GcsServer>(*gcs_controller_, line);
    if (!line.terminal_link) stage_port_ = gcs_stage_->port();
    return;
  }
  if (!options_.stage_pty.empty()) {
    serial_stage_ = std::make_unique<ModbusRtuServer>(
        *drive_,
        ModbusRtuOptions{
            .link = options_.stage_pty, .timing = options_.line_timing, .faults = &faults_, .drive = drive_.get()});
    return;
  }
  stage_ = std::make_unique<ModbusTcpServer>(
      *drive_, ModbusTcpOptions{
                   .address = options_.stage_address, .port = stage_port_, .faults = &faults_, .drive = drive_.get()});
  stage_port_ = stage_->port();
}

void Plant::unplug_stage() {
  stage_.reset();
  serial_stage_.reset();
  gcs_stage_.reset();
}

std::uint64_t Plant::stage_requests() const {
  if (gcs_stage_) return gcs_stage_->requests();
  if (stage_) return stage_->requests();
  return serial_stage_ ? serial_stage_->requests() : 0;
}

}  // namespace fvd::sim
