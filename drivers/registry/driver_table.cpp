#include "drivers/registry/driver_table.hpp"

#include "core/base/error.hpp"
#include "drivers/aravis/aravis_camera.hpp"
#include "drivers/modbus/modbus_axis.hpp"
#include "drivers/replay/replay_devices.hpp"

namespace fvd {

std::unique_ptr<Camera> open_camera(const CameraConfig& config) {
  if (config.driver == "aravis") return open_aravis_camera(config);
  if (config.driver == "replay") return open_replay_camera(config);
  throw Error(ErrorCode::kBadConfig, "camera.driver: '" + config.driver + "' is not one of: aravis, replay");
}

std::unique_ptr<Axis> open_stage(const StageConfig& config) {
  if (config.driver == "modbus") return open_modbus_stage(config);
  if (config.driver == "replay") return open_replay_stage(config);
  throw Error(ErrorCode::kBadConfig, "stage.driver: '" + config.driver + "' is not one of: modbus, replay");
}

}  // namespace fvd
