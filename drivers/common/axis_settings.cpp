#include "drivers/common/axis_controller.hpp"

namespace fvd {

AxisSettings axis_settings(const StageConfig& config) {
  return {
      config.min, config.max, config.take_up, {config.speed_um_per_s, config.acceleration_um_per_s2}, config.simulated};
}

}  // namespace fvd
