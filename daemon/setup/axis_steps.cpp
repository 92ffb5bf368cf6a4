/// Which way z grows, and how far the axis may go.

#include <cmath>
#include <optional>
#include <utility>

#include "core/base/error.hpp"
#include "daemon/setup/setup_step.hpp"

namespace fvd {

namespace {

constexpr double kJog_um = 10.0;
/// Longest way towards the part for one answer while a limit is taught.
constexpr double kLongestDown_um = 200.0;
/// Limits that lie closer leave no room for a scan.
constexpr double kLeastTravel_um = 1.0;

/// Where the axis stands, or why nobody knows.
std::string standing_text(SetupContext& context) {
  try {
    return "The axis stands at " + um_text(position(context).value) + ".";
  } catch (const Error& error) {
    if (error.code() == ErrorCode::kStageNotHomed) return "The axis has no reference.";
    return std::string("The axis cannot be asked where it stands: ") + error.what() + ".";
  }
}

SetupQuestion ask_jog(SetupContext& /*context*/) {
  SetupQuestion question;
  question.text =
      "The lens is far from everything? Watch which way it goes, by a dial gauge or against the light: the axis moves "
      "by 10 um.";
  question.choices = {{"jog", "moves the axis by +10 um", true}};
  return question;
}

SetupNext take_jog(SetupContext& context, const SetupAnswer& answer) {
  if (!answer.is("jog")) refuse_answer(answer);
  move_by(context, kJog_um);
  return SetupNext::kOn;
}

SetupQuestion ask_towards(SetupContext& /*context*/) {
  SetupQuestion question;
  question.text = "Did the lens come closer to the part?";
  question.choices = {{"yes", "towards the part: z is turned round, and the jog is asked for again", false},
                      {"no", "away from the part: z grows as it should", false},
                      {"unsure", "asks for the jog again", false}};
  return question;
}

SetupNext take_towards(SetupContext& context, const SetupAnswer& answer) {
  if (answer.is("no")) return SetupNext::kOn;
  if (answer.is("unsure")) return SetupNext::kStepBack;
  if (!answer.is("yes")) refuse_answer(answer);
  StageConfig& stage = context.draft.devices.stage;
  stage.reversed = !stage.reversed;
  stage.min = -std::exchange(stage.max, -stage.min);
  context.note = "z is turned round; the next jog has to go away from the part";
  return SetupNext::kStepBack;
}

/// Answers of both limits. here: what becomes of it.
std::vector<SetupChoice> limit_choices(const std::string& which) {
  return {{"up UM", "moves away from the part, by 1000 um at most", true},
          {"down UM", "moves towards the part, by 200 um at most", true},
          {"here", "the " + which + " limit is where the axis stands", false},
          {"at UM", "the " + which + " limit is this position; nothing moves", false}};
}

/// The position that was taught; nothing where the answer was a motion.
std::optional<Micrometers> taught(SetupContext& context, const SetupAnswer& answer) {
  if (answer.begins("up", 2)) {
    move_by(context, answer.number(1, 0.01, kLongestUp_um, "distance in um"));
    return std::nullopt;
  }
  if (answer.begins("down", 2)) {
    move_by(context, -answer.number(1, 0.01, kLongestDown_um, "distance in um"));
    return std::nullopt;
  }
  if (answer.is("here")) return position(context);
  if (answer.begins("at", 2)) {
    const StageConfig& stage = context.draft.devices.stage;
    return Micrometers{answer.number(1, stage.min.value, stage.max.value, "position within the travel, in um")};
  }
  refuse_answer(answer);
}

SetupQuestion ask_upper(SetupContext& context) {
  SetupQuestion question;
  question.text = "The upper limit, the highest that the lens is ever to go. " + standing_text(context);
  question.choices = limit_choices("upper");
  return question;
}

SetupNext take_upper(SetupContext& context, const SetupAnswer& answer) {
  const auto limit = taught(context, answer);
  if (!limit) return SetupNext::kStay;
  const Micrometers lowest = context.draft.devices.stage.min;
  if (limit->value < lowest.value + kLeastTravel_um) {
    throw Error(ErrorCode::kBadInput, um_text(limit->value) + " leaves no travel above " + um_text(lowest.value));
  }
  context.draft.upper_limit = limit;
  context.note = "upper limit " + um_text(limit->value);
  return SetupNext::kOn;
}

SetupQuestion ask_lower(SetupContext& context) {
  SetupQuestion question;
  question.text =
      "The lower limit, the closest that the lens is ever to come to the part: with the part in place, well before "
      "they touch. A scan begins below the surface, by its take-up of " +
      um_text(context.draft.devices.stage.take_up.value) + " more. " + standing_text(context);
  question.choices = limit_choices("lower");
  return question;
}

SetupNext take_lower(SetupContext& context, const SetupAnswer& answer) {
  const auto limit = taught(context, answer);
  if (!limit) return SetupNext::kStay;
  const Micrometers upper = context.draft.upper_limit.value();
  if (limit->value > upper.value - kLeastTravel_um) {
    throw Error(ErrorCode::kBadInput, um_text(limit->value) + " leaves no travel below " + um_text(upper.value));
  }
  // Both at once: an axis of other limits is opened anew, and some drives have no reference then.
  context.draft.devices.stage.min = *limit;
  context.draft.devices.stage.max = upper;
  context.note = "lower limit " + um_text(limit->value);
  return SetupNext::kOn;
}

}  // namespace

Micrometers position(SetupContext& context) {
  const StageStatus status = context.bench.stage(context.draft.devices.stage).status();
  if (!status.homed) throw Error(ErrorCode::kStageNotHomed, "the axis has no reference: where it stands means nothing");
  return status.position;
}

SettleCriterion settle_within(const StageConfig& stage, double distance_um) {
  // Twice the way at full speed, and the ramps.
  const double way_s = 2.0 * distance_um / stage.speed_um_per_s + stage.speed_um_per_s / stage.acceleration_um_per_s2;
  SettleCriterion criterion;
  criterion.timeout += std::chrono::milliseconds(static_cast<std::int64_t>(std::ceil(way_s * 1e3)));
  return criterion;
}

void move_by(SetupContext& context, double distance_um) {
  Axis& stage = context.bench.moving_stage(context.draft.devices.stage);
  const Micrometers target = position(context) + Micrometers{distance_um};
  if (const auto upper = context.draft.upper_limit; upper && target > *upper) {
    throw Error(ErrorCode::kStageLimit, um_text(target.value) + " is above the upper limit of " +
                                            um_text(upper->value) + "; nothing was moved");
  }
  const MoveRecord move =
      stage.move_to(target, settle_within(context.draft.devices.stage, std::abs(distance_um)), context.stop);
  context.note = "the axis stands at " + um_text(move.position.value);
}

std::vector<SetupStep> axis_steps() {
  return {{"jog", nullptr, ask_jog, take_jog},
          {"towards", nullptr, ask_towards, take_towards},
          {"upper_limit", nullptr, ask_upper, take_upper},
          {"lower_limit", nullptr, ask_lower, take_lower}};
}

}  // namespace fvd
