#include "daemon/api/methods/methods.hpp"

#include <memory>

#include "daemon/api/method_docs.hpp"
#include "daemon/api/result_fields.hpp"

namespace fvd {

namespace {

void describe_openrpc(Fields& fields) {
  const ResultFields result(fields);
  result.text("openrpc", "version of OpenRPC");
  result.any("info", "an object: title, version");
  result.any("methods", "a list of objects, one per method");
  result.any("x-errors", "a list of objects: code, name, retry, meaning of every error");
  result.any("x-line", "an object: in which order and how patiently the program of a line asks");
}

}  // namespace

MethodTable all_methods(const Services& services) {
  MethodTable methods;
  add_system_methods(methods, services, std::chrono::steady_clock::now());
  add_health_methods(methods, services);
  add_recipe_methods(methods, services);
  add_job_methods(methods, services);
  add_result_methods(methods, services);
  add_profile_methods(methods, services);
  add_camera_methods(methods, services);
  add_stage_methods(methods, services);
  add_objective_methods(methods, services);
  add_study_methods(methods, services);
  add_history_methods(methods, services);
  add_alarm_methods(methods, services);
  add_access_methods(methods, services);
  // Last, for it describes all, itself too.
  Method& discover = methods["rpc.discover"];
  discover.about = {.summary = "OpenRPC description of all methods",
                    .role = Role::kView,
                    .params = described<NoParams>(),
                    .result = describe_openrpc};
  const auto document = std::make_shared<const Reply>(openrpc_document(methods));
  // 100 KiB of text take a millisecond to write: not on the network thread.
  discover.run = [document](const Call&) { return *document; };
  return methods;
}

}  // namespace fvd
