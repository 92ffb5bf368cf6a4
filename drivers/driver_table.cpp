#include "drivers/driver_table.hpp"

#include "core/error.hpp"

namespace fvd {

std::unique_ptr<Camera> open_camera(const CameraConfig& config) {
  throw Error(ErrorCode::kBadConfig, "camera.driver: '" + config.driver + "' is not one of: ");
}

std::unique_ptr<ZStage> open_stage(const StageConfig& config) {
  throw Error(ErrorCode::kBadConfig, "stage.driver: '" + config.driver + "' is not one of: ");
}

}  // namespace fvd
