/// What the camera shows: bright enough, sharp, the right way round, and how large a pixel is.

#include <algorithm>
#include <cmath>
#include <sstream>

#include "core/base/error.hpp"
#include "core/scan/autofocus.hpp"
#include "daemon/setup/setup_step.hpp"

namespace fvd {

namespace {

/// 0.1 % of the pixels may be brighter than this share of full scale.
constexpr double kExposureTarget = 0.8;
/// Longest way towards the part for one answer while the surface is looked for, and longest reach of the autofocus.
constexpr double kLongestFocus_um = 100.0;
constexpr double kLongestReach_um = 300.0;
constexpr double kLeastReach_um = 5.0;
constexpr int kAutofocusSteps = 60;

/// Takes a picture and says in the note what it shows.
void look(SetupContext& context) {
  const SetupBench::Picture seen = context.bench.take_picture(context.draft, context.stop);
  std::ostringstream note;
  note.precision(4);
  if (!context.note.empty()) note << context.note << "; ";
  note << "picture of " << seen.width_px << " x " << seen.height_px << " pixels: sharpness " << seen.focus << ", grey "
       << seen.grey.p01 << " to " << seen.grey.p999 << ", " << 100.0 * seen.grey.saturated_fraction
       << " % saturated, exposure " << context.draft.picture.exposure_us << " us";
  context.note = note.str();
  context.draft.seen_px = {seen.width_px, seen.height_px};
}

/// What nobody looked at is not kept.
void require_picture(const SetupContext& context) {
  if (context.draft.seen_px) return;
  throw Error(ErrorCode::kBadInput, "no picture was taken since this question came up: answer 'picture' first");
}

SetupChoice look_again() { return {"picture", "takes another picture", false}; }

SetupQuestion ask_exposure(SetupContext& /*context*/) {
  SetupQuestion question;
  question.text =
      "The light as it will be for measuring. Is the picture bright enough? Nothing may be saturated where it is "
      "sharp.";
  question.choices = {{"auto", "looks for the exposure by up to eight pictures", false},
                      {"US", "this exposure in us", false},
                      look_again(),
                      {"ok", "keeps the exposure", false}};
  return question;
}

SetupNext take_exposure(SetupContext& context, const SetupAnswer& answer) {
  SetupDraft& draft = context.draft;
  if (answer.is("ok")) {
    require_picture(context);
    return SetupNext::kOn;
  }
  if (answer.is("auto")) {
    Camera& camera = context.bench.camera(draft.devices.camera);
    const ExposureFound found =
        find_exposure(camera, context.bench.clock(), draft.picture, kExposureTarget, context.stop);
    draft.picture.exposure_us = std::round(found.exposure_us);
    if (!found.reached) context.note = "the exposure was not reached within eight pictures: change the light";
  } else if (!answer.is("picture")) {
    if (answer.size() != 1) refuse_answer(answer);
    draft.picture.exposure_us = answer.number(0, 1.0, 1e7, "exposure in us");
  }
  look(context);
  return SetupNext::kStay;
}

SetupQuestion ask_focus(SetupContext& context) {
  const StageConfig& stage = context.draft.devices.stage;
  SetupQuestion question;
  question.text = "Lay a letter F under the lens, upright as you want to see it, and bring it into focus.";
  question.choices = {
      {"up UM", "moves away from the part, by 1000 um at most", true},
      {"down UM", "moves towards the part, by 100 um at most", true},
      {"auto UM",
       "moves through so much below and above, 300 um at most and within " + um_text(stage.min.value) + " to " +
           um_text(stage.max.value) + ", and to where the middle of the picture is sharpest; it begins " +
           um_text(stage.take_up.value) + " below that, to take up the backlash",
       true},
      look_again(),
      {"ok", "the letter is sharp", false}};
  return question;
}

/// Looks so far to both sides of where the axis stands: a range that was not bounded would be stepped through too
/// coarsely for the letter, and would begin at the lower limit with the part in place.
void focus_by_itself(SetupContext& context, double reach_um) {
  const StageConfig& config = context.draft.devices.stage;
  AutofocusPlan plan;
  const Micrometers here = position(context);
  const Micrometers lowest = config.min + config.take_up;  // every move arrives from below
  plan.from = std::max(here - Micrometers{reach_um}, lowest);
  plan.to = std::min(here + Micrometers{reach_um}, config.max);
  plan.step = Micrometers{std::max(1.0, (plan.to - plan.from).value / kAutofocusSteps)};
  plan.settle =
      settle_within(config, std::abs((here - plan.from).value) + (plan.to - plan.from + config.take_up).value);
  Axis& stage = context.bench.moving_stage(config);
  check_plan(plan, stage.info());
  Camera& camera = context.bench.camera(context.draft.devices.camera);
  (void)camera.configure(context.draft.picture);
  const AutofocusResult found = autofocus(camera, stage, context.bench.clock(), plan, context.stop);
  context.note = "sharpest at " + um_text(found.z_um);
}

SetupNext take_focus(SetupContext& context, const SetupAnswer& answer) {
  if (answer.is("ok")) {
    require_picture(context);
    context.draft.focus_um = position(context).value;
    return SetupNext::kOn;
  }
  if (answer.begins("up", 2)) {
    move_by(context, answer.number(1, 0.01, kLongestUp_um, "distance in um"));
  } else if (answer.begins("down", 2)) {
    move_by(context, -answer.number(1, 0.01, kLongestFocus_um, "distance in um"));
  } else if (answer.begins("auto", 2)) {
    focus_by_itself(context, answer.number(1, kLeastReach_um, kLongestReach_um, "reach in um"));
  } else if (!answer.is("picture")) {
    refuse_answer(answer);
  }
  look(context);
  return SetupNext::kStay;
}

SetupQuestion ask_orientation(SetupContext& /*context*/) {
  SetupQuestion question;
  question.text =
      "How does the F look in the picture? One that lies on its side: turn the camera in its mount by a quarter, and "
      "take another picture.";
  question.choices = {{"upright", "as it lies under the lens: so the camera stays", false},
                      {"mirrored", "its arms point to the left", false},
                      {"flipped", "its arms point to the right, and it stands on its head", false},
                      {"turned", "its arms point to the left, and it stands on its head", false},
                      look_again()};
  return question;
}

SetupNext take_orientation(SetupContext& context, const SetupAnswer& answer) {
  if (answer.is("upright")) {
    require_picture(context);
    return SetupNext::kOn;
  }
  CameraConfig& camera = context.draft.devices.camera;
  if (!answer.is("mirrored") && !answer.is("flipped") && !answer.is("turned") && !answer.is("picture")) {
    refuse_answer(answer);
  }
  camera.mirror_x = camera.mirror_x != (answer.is("mirrored") || answer.is("turned"));
  camera.mirror_y = camera.mirror_y != (answer.is("flipped") || answer.is("turned"));
  if (!answer.is("picture")) context.note = "pictures are turned round from now on; the F must be upright in this one";
  look(context);
  return SetupNext::kStay;
}

SetupQuestion ask_pitch(SetupContext& /*context*/) {
  SetupQuestion question;
  question.text =
      "How large is a pixel on the part? Lay a scale under the lens, take a picture, and tell two places on it and "
      "their distance.";
  question.choices = {{"X1 Y1 X2 Y2 UM", "two places in pixels and their distance in um", false},
                      {"UM", "the size of a pixel in um, e.g. the camera's divided by the magnification", false},
                      look_again(),
                      {"unknown", "later: lateral lengths are in pixels of 1 um until then", false}};
  return question;
}

SetupNext take_pitch(SetupContext& context, const SetupAnswer& answer) {
  if (answer.is("picture")) {
    look(context);
    return SetupNext::kStay;
  }
  if (answer.is("unknown")) {
    context.draft.pixel_pitch_um.reset();
    return SetupNext::kOn;
  }
  constexpr double kLargest_um = 1e5;
  if (answer.size() == 1) {
    context.draft.pixel_pitch_um = answer.number(0, 1e-4, kLargest_um, "size in um");
  } else if (answer.size() == 5) {
    require_picture(context);
    const int width_px = context.draft.seen_px->first;
    const int height_px = context.draft.seen_px->second;
    const auto at = [&](std::size_t index) {
      return answer.number(index, 0.0, (index % 2 == 0 ? width_px : height_px) - 1.0, "place in the picture in pixels");
    };
    const double distance_px = std::hypot(at(2) - at(0), at(3) - at(1));
    if (distance_px < 10.0) throw Error(ErrorCode::kBadInput, "the places are less than 10 pixels apart");
    context.draft.pixel_pitch_um = answer.number(4, 1e-3, kLargest_um, "distance in um") / distance_px;
  } else {
    refuse_answer(answer);
  }
  context.note = "a pixel is " + um_text(*context.draft.pixel_pitch_um);
  return SetupNext::kOn;
}

}  // namespace

std::vector<SetupStep> picture_steps() {
  return {{"exposure", nullptr, ask_exposure, take_exposure},
          {"focus", nullptr, ask_focus, take_focus},
          {"orientation", nullptr, ask_orientation, take_orientation},
          {"pixel_pitch", nullptr, ask_pitch, take_pitch}};
}

}  // namespace fvd
