/// The stage between the jobs.

#include "daemon/api/json_shapes.hpp"
#include "daemon/api/methods/device_task.hpp"
#include "daemon/api/methods/methods.hpp"
#include "daemon/api/result_fields.hpp"
#include "daemon/jobs/device_commands.hpp"

namespace fvd {

namespace {

constexpr NumberRange kStageRange_um{-1e6, 1e6};

struct FocusParams {
  ImageParams image;
  double from_um = 0.0;
  double to_um = 0.0;
  std::optional<double> step_um;

  void describe(Fields& fields) {
    image.describe(fields);
    fields.number("from_um", from_um, kStageRange_um, "lower end of the range");
    fields.require("from_um");
    fields.number("to_um", to_um, kStageRange_um, "upper end of the range");
    fields.require("to_um");
    fields.optional("step_um", step_um, [](Fields& inner, double& value) {
      inner.number("step_um", value, {1e-3, 1e5}, "of the coarse scan; absent = a tenth of the range");
    });
  }

  [[nodiscard]] AutofocusPlan plan() const {
    AutofocusPlan plan;
    plan.from = Micrometers{from_um};
    plan.to = Micrometers{to_um};
    plan.step = Micrometers{step_um.value_or((to_um - from_um) / 10.0)};
    return plan;
  }
};

struct MoveParams {
  double z_um = 0.0;

  void describe(Fields& fields) {
    fields.number("z_um", z_um, kStageRange_um, "where to; the stage's limits hold");
    fields.require("z_um");
  }
};

void describe_focus(Fields& fields) {
  const ResultFields result(fields);
  result.number("z_um", "where the stage stands now");
  result.number("focus", "sharpness there, grey levels");
  result.any("curve_um_focus", "a list of pairs: position, sharpness");
}

void describe_homed(Fields& fields) {
  const ResultFields result(fields);
  result.number("z_um", "where the stage stands now");
  result.boolean("homed", "true");
}

constexpr std::int64_t kLongestJog_ms = 150;

struct JogParams {
  std::string direction = "up";
  double speed_um_per_s = 10.0;
  std::int64_t until_ms = kLongestJog_ms;

  void describe(Fields& fields) {
    fields.choice("direction", direction, {"up", "down"}, "up = greater z");
    fields.require("direction");
    fields.number("speed_um_per_s", speed_um_per_s, positive(1e6),
                  "at most stage.speed_um_per_s; slower where the axis would need over 40 ms to halt");
    fields.require("speed_um_per_s");
    fields.integer64("until_ms", until_ms, {10, kLongestJog_ms},
                     "so long after this request came the axis halts, unless the request is repeated before");
  }

  [[nodiscard]] JogRequest request(const Caller& caller) const {
    const HostTime from = caller.received == HostTime{} ? HostClock::now() : caller.received;
    return {direction == "up", speed_um_per_s, from + std::chrono::milliseconds(until_ms), caller.who.name, from};
  }
};

void describe_jog(Fields& fields) {
  const ResultFields result(fields);
  result.boolean("begins", "false: a jog that runs goes on");
}

std::string_view stopped_name(JobService::Stopped stopped) {
  if (stopped == JobService::Stopped::kJob) return "job";
  return stopped == JobService::Stopped::kCommand ? "command" : "nothing";
}

void describe_stopped(Fields& fields) {
  const ResultFields result(fields);
  result.text("stopped", "what had the stage: job, command, nothing");
  result.boolean("standstill",
                 "true: measured, nothing moves the stage, and its newest sample says so too. false: not known, the "
                 "motion is just being ended, the stage is lost, or somebody else moves it: stage.standstill of "
                 "system.health tells; where it does not follow within seconds look at the axis, and use the emergency "
                 "stop");
}

void describe_moved(Fields& fields) { ResultFields(fields).number("z_um", "where the stage stands now"); }

const std::vector<ErrorCode> kMotionErrors{ErrorCode::kStageDisconnected, ErrorCode::kStageLimit,
                                           ErrorCode::kStageNotHomed,     ErrorCode::kStagePosition,
                                           ErrorCode::kStageAlarm,        ErrorCode::kStageTaken};

void add_stop_and_jog(MethodTable& methods, const Services& services) {
  methods["stage.stop"] = {
      .about = {.summary = "Ends whatever moves the stage, and what was asked for before and would; needs no control, "
                           "waits for nothing",
                .role = Role::kOperate,
                .params = described<NoParams>(),
                .result = describe_stopped,
                .is_urgent = true,
                .is_audited = true},
      .peek = [services](const Call&) -> std::optional<Answer> {
        const auto stopped = services.jobs.stop_motion();
        return Reply{{"stopped", stopped_name(stopped)}, {"standstill", services.machine.stage_stands()}};
      }};
  auto errors = kMotionErrors;
  errors.insert(errors.end(), {ErrorCode::kNotReady, ErrorCode::kBusy, ErrorCode::kTimeout, ErrorCode::kAborted,
                               ErrorCode::kShuttingDown});
  methods["stage.jog"] = {
      .about = {.summary = "Moves the stage inside its soft limits while it is repeated; why it ended is told to the "
                           "next repeat",
                .role = Role::kSetUp,
                .params = described<JogParams>(),
                .result = describe_jog,
                .errors = std::move(errors),
                .moves_stage = true,
                .needs_control = true,
                .is_audited = true,
                .needs_id = true},
      .peek = with<JogParams>(
          [&tasks = services.tasks](const Call& call, const JogParams& params) -> std::optional<Answer> {
            if (!tasks.extend_jog(params.request(call.caller))) return std::nullopt;
            return Reply{{"begins", false}};
          }),
      .run = with<JogParams>([&tasks = services.tasks](const Call& call, const JogParams& params) -> Answer {
        tasks.jog(params.request(call.caller));
        return Reply{{"begins", true}};
      })};
}

}  // namespace

void add_stage_methods(MethodTable& methods, const Services& services) {
  auto focus_errors = kMotionErrors;
  focus_errors.insert(focus_errors.end(),
                      {ErrorCode::kBadInput, ErrorCode::kUnknownRecipe, ErrorCode::kBadRecipe,
                       ErrorCode::kCameraDisconnected, ErrorCode::kCameraFramesLost, ErrorCode::kCameraTimeout,
                       ErrorCode::kCameraSettings, ErrorCode::kCameraNoFrames, ErrorCode::kFocusRange});
  methods["stage.autofocus"] = {
      .about = task_description("Moves the stage to where the middle of the image is sharpest", Role::kSetUp,
                                described<FocusParams>(), describe_focus, focus_errors, TaskMotion::kMoves),
      .run = with<FocusParams>([services](const Call& call, const FocusParams& params) -> Answer {
        require_wait(call);
        return reply_when_done(
            services.tasks.submit(autofocus_work(params.image.settings(services.recipes), params.plan()),
                                  TaskMotion::kMoves, call.caller.received));
      })};
  methods["stage.home"] = {
      .about = task_description("Finds the stage's reference", Role::kOperate, described<NoParams>(), describe_homed,
                                kMotionErrors, TaskMotion::kMoves),
      .run = [&tasks = services.tasks](const Call& call) -> Answer {
        require_wait(call);
        return reply_when_done(tasks.submit(home_work(), TaskMotion::kMoves, call.caller.received));
      }};
  methods["stage.move"] = {
      .about = task_description("Moves the stage", Role::kSetUp, described<MoveParams>(), describe_moved, kMotionErrors,
                                TaskMotion::kMoves),
      .run = with<MoveParams>([&tasks = services.tasks](const Call& call, const MoveParams& params) -> Answer {
        require_wait(call);
        return reply_when_done(
            tasks.submit(move_work(Micrometers{params.z_um}), TaskMotion::kMoves, call.caller.received));
      })};
  add_stop_and_jog(methods, services);
  methods["stage.accuracy"] = {
      .about = {.summary = "The stage's step errors over all scans, kept in stage_history.json",
                .role = Role::kView,
                .params = described<NoParams>(),
                .result = describe_stage_history},
      .run = [&tasks = services.tasks](const Call&) { return stage_history_json(tasks.stage_history()); }};
}

}  // namespace fvd
