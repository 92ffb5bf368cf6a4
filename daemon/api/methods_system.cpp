#include "daemon/api/json_shapes.hpp"
#include "daemon/api/methods.hpp"
#include "daemon/base/version.hpp"

namespace fvd {

namespace {

using nlohmann::ordered_json;

ordered_json schema_of(const Param& param) {
  ordered_json schema = ordered_json::object();
  if (param.type == ParamType::kText) schema["type"] = "string";
  if (param.type == ParamType::kInteger) schema["type"] = "integer";
  if (param.type == ParamType::kNumber) schema["type"] = "number";
  if (param.range) {
    const auto bound = [&](double value) {
      return param.type == ParamType::kInteger ? ordered_json(static_cast<std::int64_t>(value)) : ordered_json(value);
    };
    schema["minimum"] = bound(param.range->least);
    schema["maximum"] = bound(param.range->most);
  }
  return schema;
}

}  // namespace

ordered_json describe_methods(const MethodTable& methods) {
  ordered_json described = ordered_json::array();
  for (const auto& [name, method] : methods) {
    ordered_json params = ordered_json::array();
    for (const Param& param : method.params) {
      params.push_back({{"name", param.name},
                        {"description", param.meaning},
                        {"required", param.required},
                        {"schema", schema_of(param)}});
    }
    described.push_back({{"name", name},
                         {"summary", method.summary},
                         {"params", params},
                         {"result", {{"name", "result"}, {"schema", {{"type", "object"}}}}}});
  }
  return {{"openrpc", "1.2.6"}, {"info", {{"title", "fvd"}, {"version", kVersion}}}, {"methods", described}};
}

void add_system_methods(MethodTable& methods, const Services& services, std::chrono::steady_clock::time_point started) {
  const auto heartbeat = [started] {
    return std::chrono::duration_cast<std::chrono::seconds>(std::chrono::steady_clock::now() - started).count();
  };
  methods["system.ping"] = {.summary = "Heartbeat",
                            .params = {{"t", ParamType::kAny, false, "returned as it came; at most 64 bytes as JSON"}},
                            .peek = [services, heartbeat](const Call& call) {
                              ordered_json result{{"hb", heartbeat()}, {"epoch", services.machine.snapshot()->epoch}};
                              if (call.params.contains("t")) result["t"] = call.params["t"];
                              return result;
                            }};
  methods["system.info"] = {
      .summary = "Who answers", .params = {}, .peek = [services](const Call&) {
        return ordered_json{
            {"name", "fvd"}, {"version", kVersion}, {"api", 1}, {"simulated", services.machine.snapshot()->simulated}};
      }};
  methods["system.state"] = {.summary = "The machine's state, flat and cheap to poll",
                             .params = {},
                             .peek = [services, heartbeat](const Call&) {
                               return machine_status_json(*services.machine.snapshot(), heartbeat());
                             }};
  methods["stage.accuracy"] = {
      .summary = "The stage's step errors over all scans so far", .params = {}, .run = [services](const Call&) {
        return stage_history_json(services.tasks.stage_history());
      }};
  methods["rpc.discover"] = {.summary = "OpenRPC description of all methods",
                             .params = {},
                             .peek = [&methods](const Call&) { return describe_methods(methods); }};
}

}  // namespace fvd
