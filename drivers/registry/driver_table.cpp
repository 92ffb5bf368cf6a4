#include "drivers/registry/driver_table.hpp"

#include <algorithm>

#include "core/base/error.hpp"
#include "drivers/aravis/aravis_camera.hpp"
#include "drivers/common/drive_lock.hpp"
#include "drivers/common/mirrored_camera.hpp"
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
      {DeviceKind::kAxis, "modbus", "a drive by its profile", describe_modbus, check_modbus, open_modbus_stage, true},
      {DeviceKind::kAxis, "gcs", "a controller of Physik Instrumente", describe_gcs, check_gcs, open_gcs_stage, true},
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

void describe(CameraConfig& config, Fields& fields) {
  fields.choice("driver", config.driver, names_of(camera_drivers()), meanings_of(camera_drivers()));
  describe_all_cameras(config, fields);
  for (const CameraDriver& row : camera_drivers()) row.describe(config, fields);
}

/// What the chosen row finds, unless what the choice rests on was refused when it was read.
template <typename Row, typename Config>
void check(const std::vector<Row>& rows, const Config& config, const Problems& read,
           std::initializer_list<std::string_view> rests_on, Problems& found) {
  const auto refused = [&read](std::string_view pointer) { return is_reported(read, pointer); };
  if (std::any_of(rests_on.begin(), rests_on.end(), refused)) return;
  if (const Row* const row = find(rows, config.driver)) row->check(config, found);
}

}  // namespace

void describe(StageConfig& config, Fields& fields) {
  fields.choice("driver", config.driver, names_of(axis_drivers()), meanings_of(axis_drivers()));
  describe_all_stages(config, fields);
  for (const AxisDriver& row : axis_drivers()) row.describe(config, fields);
}

void describe(DeviceConfigs& devices, Fields& fields) {
  fields.group("camera", "the camera", [&](Fields& in) { describe(devices.camera, in); });
  fields.group("stage", "the Z stage", [&](Fields& in) { describe(devices.stage, in); });
}

void check_driver(const StageConfig& config, Problems& problems) { check(axis_drivers(), config, {}, {}, problems); }

Problems check_devices(const DeviceConfigs& devices, const Problems& read) {
  Problems found;
  check(camera_drivers(), devices.camera, read, {"/camera/driver"}, found);
  check(axis_drivers(), devices.stage, read, {"/stage/driver", "/stage/transport"}, found);
  return found;
}

std::unique_ptr<Camera> open_camera(const CameraConfig& config) {
  return upright(open(camera_drivers(), config, "camera"), {config.mirror_x, config.mirror_y});
}
std::unique_ptr<Axis> open_stage(const StageConfig& config) { return open(axis_drivers(), config, "stage"); }

DeviceOpeners openers_of(const DeviceConfigs& devices) {
  const AxisDriver* const driver = find(axis_drivers(), devices.stage.driver);
  const bool locked = driver != nullptr && driver->locked;
  const auto open_axis = [locked, config = std::make_shared<StageConfig>(devices.stage)] {
    if (locked && !config->lock) config->lock = std::make_shared<const DriveLock>(*config);
    return open_stage(*config);
  };
  return {.camera = [config = devices.camera] { return open_camera(config); }, .axis = open_axis};
}

}  // namespace fvd
