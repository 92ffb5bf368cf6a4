#include "daemon/jobs/job_values.hpp"

#include <string>

namespace fvd {

namespace {

std::string verdict_text(const std::optional<Verdict>& verdict) {
  return verdict ? std::string(verdict_name(*verdict)) : std::string();
}

/// Of a value of the evaluation or of the map.
template <typename Value>
StoredValue job_value(const std::string& measurement, const std::string& name, const Value& value) {
  const Limits limits = value.limits.value_or(Limits{});
  return {measurement,      name,         value.value,  value.u,
          value.expanded_u, limits.lower, limits.upper, verdict_text(value.verdict)};
}

void add_measurement(const std::string& name, const EvaluatedMeasurement& measurement,
                     std::vector<StoredValue>& values) {
  for (const auto& [key, value] : measurement.values) values.push_back(job_value(name, key, value));
  if (!measurement.values.empty()) return;
  StoredValue missing;
  missing.measurement = name;
  missing.name = measurement.main_value.empty() ? name : measurement.main_value;
  missing.verdict = verdict_text(measurement.verdict);
  values.push_back(std::move(missing));
}

}  // namespace

std::vector<StoredValue> values_of(const Result& result) {
  std::vector<StoredValue> values;
  bool has_own_map = false;
  if (result.evaluation) {
    const auto& measurements = result.evaluation->measurements;
    for (const std::string& name : result.evaluation->order) {
      const auto found = measurements.find(name);
      if (found != measurements.end()) add_measurement(name, found->second, values);
    }
    has_own_map = measurements.contains(kMapMeasurement);
  }
  if (has_own_map) return values;
  for (const MeasuredValue& value : result.measurements) {
    values.push_back(job_value(kMapMeasurement, value.name, value));
  }
  return values;
}

}  // namespace fvd
