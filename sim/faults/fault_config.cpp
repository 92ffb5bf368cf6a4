#include "sim/faults/fault_config.hpp"

#include <algorithm>

#include "config/field_reader.hpp"
#include "config/strict_json.hpp"

namespace fvd::sim {

namespace {

const std::vector<std::string> kOn{"read", "write", "any"};
const std::vector<std::string> kCameraEvents{"command", "trigger", "frame"};

std::ptrdiff_t index_of(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) - names.begin();
}

FaultStep read_step(const nlohmann::json& object, const std::string& pointer, Problems& problems) {
  FaultStep step;
  std::string on = kOn[static_cast<std::size_t>(step.on)];
  std::string fault = fault_names().front();
  int address = -1;
  std::int64_t delay_ms = 0;
  std::vector<double> words;
  FieldReader fields(object, problems, pointer);
  fields.choice("on", on, kOn, "requests that count");
  fields.integer("after", step.after, {0, 1'000'000'000}, "so many of them pass first");
  fields.integer("address", address, {0, 0xFFFF}, "PDU address that they contain");
  fields.integer("count", step.count, {1, 1'000'000'000}, "how often");
  fields.choice("fault", fault, fault_names(), "what happens");
  fields.require("fault");
  fields.integer("delay_ms", delay_ms, {0, 600'000}, "how late, or how long");
  fields.integer("code", step.code, {0, 0xFFFF}, "of the exception or alarm");
  fields.integer("to", step.to, {0, 0xFFFF}, "register from which another master writes");
  fields.numbers("words", words, {0, 0xFFFF}, {1, 123}, "what it writes");
  fields.finish();
  step.on = static_cast<FaultOn>(index_of(kOn, on));
  step.fault = static_cast<FaultKind>(index_of(fault_names(), fault));
  step.delay = std::chrono::milliseconds(delay_ms);
  if (address >= 0) step.address = address;
  for (std::size_t i = 0; i < words.size(); ++i) {
    step.words.push_back(static_cast<std::uint16_t>(words[i]));
    if (step.words.back() != words[i]) problems.push_back({pointer + "/words/" + std::to_string(i), "is no integer"});
  }
  return step;
}

CameraFaultStep read_camera_step(const nlohmann::json& object, const std::string& pointer, Problems& problems) {
  CameraFaultStep step;
  std::string on;
  std::string fault = camera_fault_names().front();
  std::int64_t delay_ms = 0;
  std::int64_t step_ms = 0;
  FieldReader fields(object, problems, pointer);
  fields.choice("fault", fault, camera_fault_names(), "what happens");
  fields.require("fault");
  if (object.contains("on")) fields.choice("on", on, kCameraEvents, "where it strikes, if it can strike anywhere");
  fields.integer("after", step.after, {0, 1'000'000'000}, "so many matching events pass first");
  fields.integer("count", step.count, {1, 1'000'000'000}, "how often");
  fields.integer("delay_ms", delay_ms, {0, 600'000}, "how late, or how long");
  fields.integer("value", step.value, {0, 60'000},
                 "how far ids jump, what is promised, how much padding, or which kind");
  fields.integer("step_ms", step_ms, {-86'400'000, 86'400'000}, "how far time is off");
  fields.finish();
  if (!on.empty()) step.on = static_cast<CameraEvent>(index_of(kCameraEvents, on));
  step.fault = static_cast<CameraFault>(index_of(camera_fault_names(), fault));
  step.delay = std::chrono::milliseconds(delay_ms);
  step.step = std::chrono::milliseconds(step_ms);
  return step;
}

/// A list of steps, each read by `read` and tried out on a script of its own.
template <typename Script, typename Step, typename Read>
std::vector<Step> read_steps(std::string_view json_text, const std::string& source, Read read) {
  Problems problems;
  std::vector<Step> steps;
  const auto document = parse_strict_json(json_text, problems);
  if (document && !document->is_array()) problems.push_back({"", "is not a list of steps"});
  if (document && document->is_array()) {
    for (std::size_t i = 0; i < document->size(); ++i) {
      const std::string pointer = "/" + std::to_string(i);
      const std::size_t before = problems.size();
      steps.push_back(read((*document)[i], pointer, problems));
      if (problems.size() > before) continue;
      // What no single field shows.
      try {
        Script().add(steps.back());
      } catch (const Error& error) {
        problems.push_back({pointer, error.what()});
      }
    }
  }
  throw_if_any(problems, ErrorCode::kBadConfig, source);
  return steps;
}

}  // namespace

std::vector<FaultStep> read_fault_steps(std::string_view json_text, const std::string& source) {
  return read_steps<FaultScript, FaultStep>(json_text, source, read_step);
}

std::vector<FaultStep> load_fault_steps(const std::filesystem::path& file) {
  return read_fault_steps(read_text_file(file), file.string());
}

std::vector<CameraFaultStep> read_camera_fault_steps(std::string_view json_text, const std::string& source) {
  return read_steps<CameraFaultScript, CameraFaultStep>(json_text, source, read_camera_step);
}

std::vector<CameraFaultStep> load_camera_fault_steps(const std::filesystem::path& file) {
  return read_camera_fault_steps(read_text_file(file), file.string());
}

}  // namespace fvd::sim
