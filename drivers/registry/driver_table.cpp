#include "drivers/registry/driver_table.hpp"

#include <algorithm>

#include "core/base/error.hpp"
#include "drivers/aravis/aravis_camera.hpp"
#include "drivers/gcs/gcs_axis.hpp"
#include "drivers/modbus/modbus_axis.hpp"
#include "drivers/registry/driver_keys.hpp"
#include "drivers/replay/replay_devices.hpp"

namespace fvd {

const std::vector<CameraDriver>& camera_drivers() {
  static const std::vector<CameraDriver> kRows{
      {DeviceKind::kCamera, "aravis", "GigE Vision or USB3 Vision", describe_aravis, check_aravis,
       [](const CameraConfig& config) { return open_aravis_camera(config); }},
      {DeviceKind::kCamera, "replay", "a folder", describe_replay, check_replay, open_replay_camera},
  };
  return kRows;
}

const std::vector<AxisDriver>& axis_drivers() {
  static const std::vector<AxisDriver> kRows{
      {DeviceKind::kAxis, "modbus", "a drive by its profile", describe_modbus, check_modbus, open_modbus_stage},
      {DeviceKind::kAxis, "gcs", "a controller of Physik Instrumente", describe_gcs, check_gcs, open_gcs_stage},
      {DeviceKind::kAxis, "replay", "beside a replay camera", describe_replay, check_replay, open_replay_stage},
  };
  return kRows;
}

namespace {

template <typename Row>
std::vector<std::string> names_of(const std::vector<Row>& rows) {
  std::vector<std::string> names;
  for (const Row& row : rows) names.emplace_back(row.name);
  return names;
}

/// "modbus = a drive by its profile, replay = ..."
template <typename Row>
std::string meanings_of(const std::vector<Row>& rows) {
  std::string all;
  for (const Row& row : rows) all += (all.empty() ? "" : ", ") + std::string(row.name) + " = " + row.meaning;
  return all;
}

template <typename Row>
const Row* find(const std::vector<Row>& rows, const std::string& name) {
  const auto found = std::find_if(rows.begin(), rows.end(), [&](const Row& row) { return row.name == name; });
  return found == rows.end() ? nullptr : &*found;
}

template <typename Row, typename Config>
auto open(const std::vector<Row>& rows, const Config& config, const std::string& block) {
  if (const Row* const row = find(rows, config.driver)) return row->open(config);
  std::string known;
  for (const std::string& name : names_of(rows)) known += (known.empty() ? "" : ", ") + name;
  throw Error(ErrorCode::kBadConfig, block + ".driver: '" + config.driver + "' is not one of: " + known);
}

}  // namespace

void describe(CameraConfig& config, Fields& fields) {
  fields.choice("driver", config.driver, names_of(camera_drivers()), meanings_of(camera_drivers()));
  describe_all_cameras(config, fields);
  for (const CameraDriver& row : camera_drivers()) row.describe(config, fields);
}

void describe(StageConfig& config, Fields& fields) {
  fields.choice("driver", config.driver, names_of(axis_drivers()), meanings_of(axis_drivers()));
  describe_all_stages(config, fields);
  for (const AxisDriver& row : axis_drivers()) row.describe(config, fields);
}

void check_driver(const CameraConfig& config, Problems& problems) {
  if (const CameraDriver* const row = find(camera_drivers(), config.driver)) row->check(config, problems);
}

void check_driver(const StageConfig& config, Problems& problems) {
  if (const AxisDriver* const row = find(axis_drivers(), config.driver)) row->check(config, problems);
}

std::unique_ptr<Camera> open_camera(const CameraConfig& config) { return open(camera_drivers(), config, "camera"); }
std::unique_ptr<Axis> open_stage(const StageConfig& config) { return open(axis_drivers(), config, "stage"); }

}  // namespace fvd
