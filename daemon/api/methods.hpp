#pragma once

/// All methods of the API, a function and a file for each group.

#include <chrono>
#include <vector>

#include "daemon/api/method.hpp"

namespace fvd {

/// started: from when on the heartbeat counts.
void add_system_methods(MethodTable& methods, const Services& services, std::chrono::steady_clock::time_point started);
void add_recipe_methods(MethodTable& methods, const Services& services);
void add_job_methods(MethodTable& methods, const Services& services);
void add_result_methods(MethodTable& methods, const Services& services);
/// Camera and stage.
void add_device_methods(MethodTable& methods, const Services& services);

/// OpenRPC description.
[[nodiscard]] nlohmann::ordered_json describe_methods(const MethodTable& methods);

/// The parameters that name a job: job_id or seq.
[[nodiscard]] std::vector<Param> job_key_params();
/// Throws ProtocolError unless one of the two is there.
[[nodiscard]] JobKey job_key_from(const nlohmann::json& params);
[[nodiscard]] std::string text_or(const nlohmann::json& params, const char* name, const std::string& fallback);

}  // namespace fvd
