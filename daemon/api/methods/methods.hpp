#pragma once

/// All methods of the API, a function and a file for each group.

#include <chrono>

#include "daemon/api/method.hpp"
#include "daemon/jobs/services.hpp"

namespace fvd {

/// All of them. What services name outlives the table; the heartbeat counts from now on.
[[nodiscard]] MethodTable all_methods(const Services& services);

/// started: from when on the heartbeat counts.
void add_system_methods(MethodTable& methods, const Services& services, std::chrono::steady_clock::time_point started);
void add_health_methods(MethodTable& methods, const Services& services);
void add_recipe_methods(MethodTable& methods, const Services& services);
void add_job_methods(MethodTable& methods, const Services& services);
void add_result_methods(MethodTable& methods, const Services& services);
void add_profile_methods(MethodTable& methods, const Services& services);
void add_camera_methods(MethodTable& methods, const Services& services);
void add_stage_methods(MethodTable& methods, const Services& services);
void add_objective_methods(MethodTable& methods, const Services& services);
/// job.list, value.list.
void add_history_methods(MethodTable& methods, const Services& services);
void add_alarm_methods(MethodTable& methods, const Services& services);
/// session, control, audit.
void add_access_methods(MethodTable& methods, const Services& services);
/// verify, calibrate, gauge, study, calibration.
void add_study_methods(MethodTable& methods, const Services& services);

}  // namespace fvd
