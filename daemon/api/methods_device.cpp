#include <utility>

#include "daemon/api/methods.hpp"
#include "daemon/api/replies.hpp"
#include "daemon/api/rpc_errors.hpp"
#include "daemon/jobs/device_commands.hpp"

namespace fvd {

namespace {

using nlohmann::json;

/// A command to the devices that takes longer hangs.
constexpr std::chrono::minutes kLongestTask{5};
constexpr ParamRange kStageRange_um{-1e6, 1e6};

using BeginTask = std::function<std::shared_ptr<DeviceTask>(const json& params)>;

/// A method whose reply comes when its task is done.
void add_task(MethodTable& methods, const std::string& name, const std::string& summary, std::vector<Param> params,
              BeginTask begin) {
  methods[name] = {
      .summary = summary,
      .params = std::move(params),
      .run = [name, begin = std::move(begin)](const Call& call) -> Reply {
        if (!call.may_wait) {
          throw ProtocolError{json_rpc::kInvalidRequest, name + " takes time: not in a batch, and only with an id"};
        }
        return Deferred{begin(call.params), kLongestTask};
      },
      .needs_id = true};
}

CameraSettings settings_from(const Services& services, const json& params) {
  CameraSettings camera;
  if (params.contains("recipe")) {
    const auto id = params["recipe"].get<std::string>();
    camera = services.recipes.load(id).camera;
  }
  camera.trigger = TriggerMode::kSoftware;
  if (params.contains("exposure_us")) camera.exposure_us = params["exposure_us"].get<double>();
  if (params.contains("gain_db")) camera.gain_db = params["gain_db"].get<double>();
  return camera;
}

AutofocusPlan plan_from(const json& params) {
  AutofocusPlan plan;
  plan.from = Micrometers{params["from_um"].get<double>()};
  plan.to = Micrometers{params["to_um"].get<double>()};
  plan.step = Micrometers{params.value("step_um", (plan.to - plan.from).value / 10.0)};
  return plan;
}

}  // namespace

void add_device_methods(MethodTable& methods, const Services& services) {
  const std::vector<Param> light{
      {"recipe", ParamType::kText, false, "whose camera settings to use; absent = the defaults"},
      {"exposure_us", ParamType::kNumber, false, "in place of the recipe's", ParamRange{1e-3, 6e7}},
      {"gain_db", ParamType::kNumber, false, "in place of the recipe's", ParamRange{0.0, 100.0}}};
  add_task(methods, "camera.snap", "Takes one image, writes it as PNG, and tells its grey levels", light,
           [services](const json& params) {
             return services.tasks.submit(snap_work(settings_from(services, params)), TaskMotion::kNone);
           });
  add_task(methods, "camera.preview", "A picture for the eye: one taken now, or the newest slice of the job that runs",
           light, [services](const json& params) { return services.tasks.preview(settings_from(services, params)); });
  auto exposure = light;
  exposure.push_back({"target", ParamType::kNumber, false, "brightness of the brightest 0.1 %, 0.1..0.95; default 0.8",
                      ParamRange{0.1, 0.95}});
  add_task(methods, "camera.suggest_exposure", "Seeks the exposure; leaves the camera as it was", exposure,
           [services](const json& params) {
             return services.tasks.submit(exposure_work(settings_from(services, params), params.value("target", 0.8)),
                                          TaskMotion::kNone);
           });
  auto range = light;
  range.push_back({"from_um", ParamType::kNumber, true, "lower end of the range", kStageRange_um});
  range.push_back({"to_um", ParamType::kNumber, true, "upper end", kStageRange_um});
  range.push_back({"step_um", ParamType::kNumber, false, "of the coarse scan; default a tenth of the range",
                   ParamRange{1e-3, 1e5}});
  add_task(methods, "stage.autofocus", "Moves the stage to where the middle of the image is sharpest", range,
           [services](const json& params) {
             return services.tasks.submit(autofocus_work(settings_from(services, params), plan_from(params)),
                                          TaskMotion::kMoves);
           });
  add_task(methods, "stage.home", "Finds the stage's reference; the stage MOVES", {},
           [services](const json&) { return services.tasks.submit(home_work(), TaskMotion::kMoves); });
  add_task(methods, "stage.move", "Moves the stage; its limits hold",
           {{"z_um", ParamType::kNumber, true, "where to", kStageRange_um}}, [services](const json& params) {
             return services.tasks.submit(move_work(Micrometers{params["z_um"].get<double>()}), TaskMotion::kMoves);
           });
}

}  // namespace fvd
