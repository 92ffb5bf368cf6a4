#include "core/scan/stage_run.hpp"

#include <cmath>
#include <sstream>

#include "core/base/error.hpp"

namespace fvd {

namespace {

double milliseconds_between(HostTime from, HostTime to) {
  return std::chrono::duration<double, std::milli>(to - from).count();
}

void check_plan(const StageRunPlan& plan, const StageInfo& stage) {
  std::ostringstream message;
  if (!(plan.to > plan.from)) {
    message << "from " << plan.from.value << " to " << plan.to.value << " um: the end must lie above the start";
  } else if (plan.steps < 1 || plan.repeats < 1) {
    message << plan.steps << " steps, " << plan.repeats << " repeats: at least 1 of each is needed";
  }
  if (!message.str().empty()) throw Error(ErrorCode::kBadInput, message.str());
  const Micrometers lowest = plan.from - stage.take_up;
  const Micrometers highest = plan.to + stage.take_up;
  if (lowest >= stage.min && highest <= stage.max) return;
  message << "a run from " << plan.from.value << " to " << plan.to.value << " um with " << stage.take_up.value
          << " um of take-up at both ends needs " << lowest.value << ".." << highest.value
          << " um; the stage's limits are " << stage.min.value << ".." << stage.max.value << " um; nothing was moved";
  throw Error(ErrorCode::kStageLimit, message.str());
}

class Run {
 public:
  Run(Axis& stage, Clock& clock, const StageRunPlan& plan, std::stop_token stop)
      : stage_(stage), clock_(clock), plan_(plan), stop_(std::move(stop)), begun_(clock.now()) {}

  StagePoint measure(int repeat, int direction, Micrometers target) {
    const MoveRecord move = stage_.move_to(target, plan_.settle, stop_);
    const HostTime from = clock_.now();
    const HostTime to = from + plan_.average;
    clock_.wait_until(to, stop_);
    StagePoint point;
    point.run = repeat;
    point.direction = direction;
    point.commanded_um = target.value;
    point.quantised_um = move.target_quantised.value;
    point.measured_um = stage_.mean_position(from, to).mean.value;
    point.time_s = std::chrono::duration<double>(from - begun_).count();
    point.move_ms = milliseconds_between(move.started, move.settled);
    point.settle_ms = milliseconds_between(move.halted, move.settled);
    point.polls = move.polls;
    point.temperature_c = temperature();
    return point;
  }

  /// Beyond the pass' first position. An axis with backlash comes to rest beside the window when it arrives from the
  /// other side, so this move has a wide one.
  void take_up(int direction) {
    const Micrometers distance = stage_.info().take_up;
    if (distance.value <= 0.0) return;
    SettleCriterion wide = plan_.settle;
    wide.window = std::max(plan_.settle.window, distance * 0.5);
    stage_.move_to(direction > 0 ? plan_.from - distance : plan_.to + distance, wide, stop_);
  }

 private:
  /// The motor's where it is known: it is nearest to the screw.
  std::optional<double> temperature() {
    const auto known = stage_.status().temperatures;
    for (const StageTemperature& one : known) {
      if (one.name == "motor") return one.celsius;
    }
    return known.empty() ? std::nullopt : std::optional(known.front().celsius);
  }

  Axis& stage_;
  Clock& clock_;
  const StageRunPlan& plan_;
  std::stop_token stop_;
  HostTime begun_;
};

}  // namespace

std::vector<StagePoint> run_stage(Axis& stage, Clock& clock, const StageRunPlan& plan,
                                  const std::function<void(int, int)>& on_point, std::stop_token stop) {
  check_plan(plan, stage.info());
  if (!stage.status().homed) {
    throw Error(ErrorCode::kStageNotHomed, "the stage has no reference: home it before the run");
  }
  Run run(stage, clock, plan, stop);
  const int all = 2 * plan.repeats * (plan.steps + 1);
  std::vector<StagePoint> points;
  points.reserve(static_cast<std::size_t>(all));
  const double step_um = (plan.to - plan.from).value / plan.steps;
  for (int repeat = 0; repeat < plan.repeats; ++repeat) {
    for (const int direction : {1, -1}) {
      run.take_up(direction);
      for (int i = 0; i <= plan.steps; ++i) {
        const int position = direction > 0 ? i : plan.steps - i;
        points.push_back(run.measure(repeat, direction, Micrometers{plan.from.value + step_um * position}));
        if (on_point) on_point(static_cast<int>(points.size()), all);
      }
    }
  }
  return points;
}

}  // namespace fvd
