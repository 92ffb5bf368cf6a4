#pragma once

/// Jobs, values and alarms as members of lists, with their description.

#include <vector>

#include <nlohmann/json.hpp>

#include "daemon/api/result_fields.hpp"
#include "daemon/jobs/alarm.hpp"
#include "daemon/store/job_history.hpp"

namespace fvd {

[[nodiscard]] nlohmann::ordered_json job_row_json(const JobStatus& job);
void describe_job_row(const ResultFields& row);

[[nodiscard]] nlohmann::ordered_json value_point_json(const ValuePoint& point);
void describe_value_point(const ResultFields& point);

/// The list as it stands under "alarms".
[[nodiscard]] nlohmann::ordered_json alarms_json(const std::vector<Alarm>& alarms);
void describe_alarm(const ResultFields& alarm);

}  // namespace fvd
