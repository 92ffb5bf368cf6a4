/// Which way z grows, and how far the axis may go.

#include <optional>
#include <utility>

#include "core/base/error.hpp"
#include "daemon/setup/setup_step.hpp"

namespace fvd {

namespace {

constexpr double kJog_um = 10.0;
/// Longest way for one answer while a limit is taught: away from the part, and towards it.
constexpr double kLongestUp_um = 1000.0;
constexpr double kLongestDown_um = 200.0;
/// Limits that lie closer leave no room for a scan.
constexpr double kLeastTravel_um = 1.0;

double position_um(SetupContext& context) {
  return context.bench.stage(context.draft.devices.stage).status().position.value;
}

/// Opened anew, with another direction or other limits, some drives have no reference any more.
bool needs_reference(SetupContext& context) { return !context.bench.stage(context.draft.devices.stage).status().homed; }

SetupQuestion ask_jog(SetupContext& /*context*/) {
  SetupQuestion question;
  question.text =
      "The lens is far from everything? Watch which way it goes, by a dial gauge or against the light: the axis moves "
      "by "
      "10 um.";
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
  if (!needs_reference(context)) return SetupNext::kStepBack;
  context.note += ". The drive has forgotten its reference";
  return SetupNext::kReference;
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
  if (answer.is("here")) return Micrometers{position_um(context)};
  if (answer.begins("at", 2)) {
    const StageConfig& stage = context.draft.devices.stage;
    return Micrometers{answer.number(1, stage.min.value, stage.max.value, "position within the travel, in um")};
  }
  refuse_answer(answer);
}

SetupQuestion ask_upper(SetupContext& context) {
  SetupQuestion question;
  question.text = "The upper limit, the highest that the lens is ever to go. The axis stands at " +
                  um_text(position_um(context)) + ".";
  question.choices = limit_choices("upper");
  return question;
}

SetupNext take_upper(SetupContext& context, const SetupAnswer& answer) {
  const auto limit = taught(context, answer);
  if (!limit) return SetupNext::kStay;
  StageConfig& stage = context.draft.devices.stage;
  if (limit->value < stage.min.value + kLeastTravel_um) {
    throw Error(ErrorCode::kBadInput, um_text(limit->value) + " leaves no travel above " + um_text(stage.min.value));
  }
  stage.max = *limit;
  context.note = "upper limit " + um_text(limit->value);
  return SetupNext::kOn;
}

SetupQuestion ask_lower(SetupContext& context) {
  SetupQuestion question;
  question.text =
      "The lower limit, the closest that the lens is ever to come to the part: with the part in place, well before "
      "they "
      "touch. A scan begins below the surface, by its take-up of " +
      um_text(context.draft.devices.stage.take_up.value) + " more. The axis stands at " +
      um_text(position_um(context)) + ".";
  question.choices = limit_choices("lower");
  return question;
}

SetupNext take_lower(SetupContext& context, const SetupAnswer& answer) {
  const auto limit = taught(context, answer);
  if (!limit) return SetupNext::kStay;
  StageConfig& stage = context.draft.devices.stage;
  if (limit->value > stage.max.value - kLeastTravel_um) {
    throw Error(ErrorCode::kBadInput, um_text(limit->value) + " leaves no travel below " + um_text(stage.max.value));
  }
  stage.min = *limit;
  context.note = "lower limit " + um_text(limit->value);
  return SetupNext::kOn;
}

}  // namespace

void move_by(SetupContext& context, double distance_um) {
  Axis& stage = context.bench.moving_stage(context.draft.devices.stage);
  const Micrometers target = stage.status().position + Micrometers{distance_um};
  const MoveRecord move = stage.move_to(target, {}, context.stop);
  context.note = "the axis stands at " + um_text(move.position.value);
}

std::vector<SetupStep> axis_steps() {
  return {{"jog", nullptr, ask_jog, take_jog},
          {"towards", nullptr, ask_towards, take_towards},
          {"upper_limit", nullptr, ask_upper, take_upper},
          {"lower_limit", nullptr, ask_lower, take_lower},
          {"reference_again", needs_reference, reference_step().ask, reference_step().take}};
}

}  // namespace fvd
