/// The machine as a whole.

#include "daemon/api/json_shapes.hpp"
#include "daemon/api/methods/device_task.hpp"
#include "daemon/api/methods/job_key_params.hpp"
#include "daemon/api/methods/methods.hpp"
#include "daemon/api/replies.hpp"
#include "daemon/api/reply_form.hpp"
#include "daemon/api/result_fields.hpp"
#include "daemon/base/version.hpp"
#include "daemon/jobs/device_commands.hpp"

namespace fvd {

namespace {

struct PingParams {
  std::string t_json;  ///< empty = not given

  void describe(Fields& fields) { fields.any("t", t_json, kMaxForeignText_bytes, "returned as it came"); }
};

struct StateParams {
  ClientParam client;
  ReplyFormParams form;

  void describe(Fields& fields) {
    client.describe(fields);
    form.describe(fields, names_in<describe_machine_status>());
  }
};

void describe_ping(Fields& fields) {
  const ResultFields result(fields);
  result.integer("hb", "heartbeat: counts up once a second");
  result.integer("epoch", "counts the daemon's starts");
  result.any("t", "as given", Presence::kSometimes);
}

void describe_info(Fields& fields) {
  const ResultFields result(fields);
  result.text("name", "fvd");
  result.text("version", "of the program");
  result.integer("api", "version of the wire contract");
  result.boolean("simulated", "a device is simulated");
  result.any("camera",
             "an object: vendor, model, serial, firmware, address of the camera that is open, each cut to 32 bytes",
             Presence::kSometimes);
}

/// What a camera says of itself, in one compact reply; of GigE Vision all of it.
constexpr std::size_t kLongestOfCamera_bytes = 32;

Reply info_of(const MachineStatus& machine) {
  Reply reply{{"name", "fvd"}, {"version", kVersion}, {"api", 1}, {"simulated", machine.simulated}};
  if (const auto& camera = machine.camera) {
    const auto told = [](const std::string& text) { return cut_text(text, kLongestOfCamera_bytes); };
    reply["camera"] = {{"vendor", told(camera->vendor)},
                       {"model", told(camera->model)},
                       {"serial", told(camera->serial)},
                       {"firmware", told(camera->firmware)},
                       {"address", told(camera->address)}};
  }
  return reply;
}

void describe_reset(Fields& fields) {
  const ResultFields result(fields);
  result.number("z_um", "where the stage stands");
  result.boolean("homed", "false: call stage.home");
}

}  // namespace

void add_system_methods(MethodTable& methods, const Services& services, std::chrono::steady_clock::time_point started) {
  const auto heartbeat = [started] {
    return std::chrono::duration_cast<std::chrono::seconds>(std::chrono::steady_clock::now() - started).count();
  };
  methods["system.ping"] = {.about = {.summary = "Heartbeat",
                                      .role = Role::kView,
                                      .params = described<PingParams>(),
                                      .result = describe_ping,
                                      .is_brief = true},
                            .peek = [&machine = services.machine, heartbeat](const Call& call) -> Answer {
                              Reply reply{{"hb", heartbeat()}, {"epoch", machine.snapshot()->epoch}};
                              if (call.params.contains("t")) reply["t"] = call.params["t"];
                              return reply;
                            }};
  methods["system.info"] = {
      .about = {.summary = "Who answers",
                .role = Role::kView,
                .params = described<NoParams>(),
                .result = describe_info,
                .is_brief = true},
      .peek = [&machine = services.machine](const Call&) { return info_of(*machine.snapshot()); }};
  methods["system.state"] = {
      .about = {.summary = "The machine's state, flat and cheap to poll",
                .role = Role::kView,
                .params = described<StateParams>(),
                .result = describe_machine_status,
                .is_brief = true},
      .peek = with<StateParams>([&machine = services.machine, heartbeat](
                                    const Call& call, const StateParams& params) -> std::optional<Answer> {
        return Answer(machine_status_reply(*machine.snapshot(), params.client.checked(), heartbeat(),
                                           params.form.form(), call.envelope_bytes));
      })};
  MethodDescription reset = task_description(
      "Tells the drive to end its alarm; an error ends with its cause, and with nothing else: a drive keeps an alarm "
      "whose cause stands",
      Role::kOperate, described<NoParams>(), describe_reset, {ErrorCode::kStageAlarm, ErrorCode::kStageDisconnected},
      TaskMotion::kNone);
  reset.is_audited = true;
  methods["error.reset"] = {.about = std::move(reset), .run = [&tasks = services.tasks](const Call& call) -> Answer {
                              require_wait(call);
                              return reply_when_done(tasks.submit(reset_work(), TaskMotion::kNone));
                            }};
}

}  // namespace fvd
