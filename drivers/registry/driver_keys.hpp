#pragma once

/// The keys of each driver's configuration, and what must fit together in them.

#include "config/fields.hpp"
#include "config/problem.hpp"
#include "drivers/common/driver_config.hpp"

namespace fvd {

/// What all drivers of a kind share.
void describe_all_cameras(CameraConfig& camera, Fields& fields);
void describe_all_stages(StageConfig& stage, Fields& fields);

void describe_aravis(CameraConfig& camera, Fields& fields);
void describe_replay(CameraConfig& camera, Fields& fields);
void describe_modbus(StageConfig& stage, Fields& fields);
void describe_gcs(StageConfig& stage, Fields& fields);
void describe_replay(StageConfig& stage, Fields& fields);

void check_aravis(const CameraConfig& camera, Problems& problems);
void check_replay(const CameraConfig& camera, Problems& problems);
void check_modbus(const StageConfig& stage, Problems& problems);
void check_gcs(const StageConfig& stage, Problems& problems);
void check_replay(const StageConfig& stage, Problems& problems);

}  // namespace fvd
