/// The trial scan, and the files.

#include <algorithm>
#include <cmath>
#include <sstream>

#include "core/base/error.hpp"
#include "core/runtime/worker_pool.hpp"
#include "daemon/pipeline/measurement.hpp"
#include "daemon/pipeline/reconstruct.hpp"
#include "daemon/recipes/recipe_document.hpp"
#include "daemon/setup/setup_files.hpp"
#include "daemon/setup/setup_step.hpp"

namespace fvd {

namespace {

constexpr double kMost_um = 1e6;
constexpr int kMostSlices = 2000;
constexpr std::size_t kQueueSlices = 4;
/// The suggestion reaches so far about the focus, clear of the limits.
constexpr double kSuggestedReach_um = 50.0;

SetupQuestion ask_trial(SetupContext& context) {
  const StageConfig& stage = context.draft.devices.stage;
  std::ostringstream text;
  text.precision(6);
  text << "A trial scan. It begins " << stage.take_up.value << " um below its first slice to take up the backlash, and "
       << "stays between " << stage.min.value << " and " << stage.max.value << " um.";
  if (const auto focus = context.draft.focus_um) {
    const double lowest = stage.min.value + stage.take_up.value;
    text << " The letter was sharp at " << *focus << " um: for example scan "
         << std::ceil(std::max(lowest, *focus - kSuggestedReach_um)) << ' '
         << std::floor(std::min(stage.max.value, *focus + kSuggestedReach_um)) << " 5.";
  }
  SetupQuestion question;
  question.text = text.str();
  question.choices = {{"scan FROM TO STEP", "scans from one position to the other by such steps, all in um", true},
                      {"ok", "the heights are those of the part", false},
                      {"skip", "no trial; no recipe is written", false}};
  return question;
}

/// "97.3 % of the points are valid, heights from 49.8 to 70.3 um".
std::string heights_text(const HeightMap& map) {
  std::vector<float> heights_m;
  for (const float height : map.height_m.pixels()) {
    if (std::isfinite(height)) heights_m.push_back(height);
  }
  if (heights_m.empty()) return "no point is valid: the surface lies outside of the scan, or has no texture";
  std::sort(heights_m.begin(), heights_m.end());
  const auto at = [&](double share) {
    const float height_m = heights_m[static_cast<std::size_t>(share * static_cast<double>(heights_m.size() - 1))];
    return static_cast<double>(height_m) / kMetresPerMicrometer;
  };
  std::ostringstream text;
  text.precision(4);
  text << 100.0 * static_cast<double>(heights_m.size()) / static_cast<double>(map.height_m.pixels().size())
       << " % of the points are valid; 1 % of them lie below " << at(0.01) << " um, half below " << at(0.5)
       << " um, 99 % below " << at(0.99) << " um";
  return text.str();
}

void scan(SetupContext& context, const TrialRange& range) {
  const Recipe recipe = parse_recipe(trial_recipe(context.draft, range), "first");
  ResultData data;
  note_recipe(recipe, data);
  WorkerPool pool(1);
  MeasurementObserver observer;
  observer.on_phase = [](std::string_view) {};
  observer.on_slice = [](const SliceProgress&) {};
  observer.on_acquired = [] {};
  const DeviceConfigs& devices = context.draft.devices;
  measure(recipe,
          {context.bench.camera(devices.camera), context.bench.moving_stage(devices.stage), context.bench.clock(), pool,
           nullptr, kQueueSlices},
          observer, data, context.stop);
  context.draft.trial = range;
  context.note = heights_text(data.map);
  if (!data.suspects.empty()) context.note += "; " + std::to_string(data.suspects.size()) + " slices are suspect";
}

SetupNext take_trial(SetupContext& context, const SetupAnswer& answer) {
  if (answer.is("skip")) {
    context.draft.trial.reset();
    return SetupNext::kOn;
  }
  if (answer.is("ok")) {
    if (!context.draft.trial) throw Error(ErrorCode::kBadInput, "nothing was scanned yet: scan, or skip the trial");
    return SetupNext::kOn;
  }
  if (!answer.begins("scan", 4)) refuse_answer(answer);
  TrialRange range;
  range.start_um = answer.number(1, -kMost_um, kMost_um, "position in um");
  const double end_um = answer.number(2, range.start_um, kMost_um, "position above the first, in um");
  range.step_um = answer.number(3, 0.001, kMost_um, "step in um");
  const double slices = std::floor((end_um - range.start_um) / range.step_um + 1e-9) + 1.0;
  if (slices < 3.0 || slices > kMostSlices) {
    throw Error(ErrorCode::kBadInput, "that makes " + std::to_string(static_cast<long long>(slices)) +
                                          " slices; expected 3 to " + std::to_string(kMostSlices));
  }
  range.slices = static_cast<int>(slices);
  scan(context, range);
  return SetupNext::kStay;
}

SetupQuestion ask_file(SetupContext& context) {
  SetupQuestion question;
  question.text = "Write the configuration to " + context.options.file.string() + "?";
  question.choices = {
      {"write", "writes it, unless there is such a file", false},
      {"write FILE", "writes it there, unless there is such a file", false},
      {"replace", "puts it in the place of the file that is there, which is kept as FILE.old-N", false}};
  return question;
}

SetupNext take_file(SetupContext& context, const SetupAnswer& answer) {
  std::filesystem::path file = context.options.file;
  const bool replace = answer.is("replace");
  if (answer.word(0) == "write" && answer.size() > 1) {
    file = SetupAnswer(answer.text().substr(answer.word(0).size())).text();
  } else if (!answer.is("write") && !replace) {
    refuse_answer(answer);
  }
  context.note = write_setup(context.draft, file, replace);
  context.written = std::filesystem::absolute(file).lexically_normal();
  return SetupNext::kOn;
}

}  // namespace

std::vector<SetupStep> last_steps() {
  return {{"trial", nullptr, ask_trial, take_trial}, {"file", nullptr, ask_file, take_file}};
}

}  // namespace fvd
