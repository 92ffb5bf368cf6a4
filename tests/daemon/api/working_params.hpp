#pragma once

/// Parameters with which a call of a method would do something.

#include <string>

#include <nlohmann/json.hpp>

namespace fvd::test {

inline nlohmann::json working_params(const std::string& method) {
  if (method == "job.start") return {{"seq", 1}, {"part_id", "p"}};
  if (method == "stage.jog") return {{"direction", "up"}, {"speed_um_per_s", 10}};
  if (method == "control.acquire") return {{"owner", "test"}};
  if (method == "stage.move") return {{"z_um", 1}};
  if (method == "stage.autofocus") return {{"from_um", 0}, {"to_um", 10}};
  if (method == "recipe.prepare") return {{"id", "chapter"}};
  if (method == "recipe.save") return {{"id", "c"}, {"text", "{}"}, {"base_version", 3}, {"author", "a"}};
  if (method == "recipe.restore") return {{"id", "c"}, {"version", 1}, {"base_version", 3}, {"author", "a"}};
  if (method == "objective.confirm") return {{"name", "20x"}};
  if (method == "calibrate.accept") return {{"study", "study-0001"}, {"person", "a"}, {"renew_by", "2027-11-29"}};
  if (method == "alarm.acknowledge") return {{"number", 1}};
  if (method == "value.list") return {{"measurement", "step"}, {"value", "height_um"}};
  if (method == "result.profile") {
    return {{"job_id", "a"}, {"from_um", {{"x", 0}, {"y", 0}}}, {"to_um", {{"x", 9}, {"y", 0}}}};
  }
  if (method == "verify.noise") return {{"jobs", {"a", "b"}}};
  return nlohmann::json::object();
}

}  // namespace fvd::test
