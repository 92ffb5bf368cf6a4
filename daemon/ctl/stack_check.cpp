#include "daemon/ctl/stack_check.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <sstream>
#include <string>

#include "core/base/error.hpp"

namespace fvd::ctl {

namespace {

constexpr int kSamplesOfAPeak = 3;  ///< the sharpest and one on either side
/// Between the steps and the recipe's: more is a wrong unit, not another stage.
constexpr double kMaxStepRatio = 100.0;
constexpr double kMaxStepDifference = 0.02;  ///< as a share of the recipe's step
/// Steps of focus variation; others make a unit doubtful that nobody said.
constexpr double kMinUsualStep_um = 0.05;
constexpr double kMaxUsualStep_um = 1000.0;

constexpr const char* kSayTheUnit =
    "if its numbers are not in um, give --z-file with --z-unit mm or m; if they are, --z-unit um";

void require_enough_slices(const ProcessOptions& options, const FocusSettings& focus, int slices) {
  const int least = (kSamplesOfAPeak - 1) * focus.bin_slices + 1;
  if (slices >= least) return;
  std::ostringstream message;
  message << options.source.string() << " has " << slices << " slices; a peak needs at least " << least
          << ": the sharpest and one on either side";
  if (focus.bin_slices > 1) message << ", in bins of " << focus.bin_slices << " slices (--bin 1 needs fewer)";
  throw Error(ErrorCode::kBadInput, message.str());
}

void require_plausible_unit(const ProcessOptions& options, double step_um) {
  const double ratio = step_um / options.recipe.step_um;
  if (!options.recipe_plans_scan || !options.z_unit_assumed) return;
  if (ratio <= kMaxStepRatio && ratio >= 1.0 / kMaxStepRatio) return;
  std::ostringstream message;
  message << std::get<ZFile>(options.z).path.string() << ": the step is " << step_um << " um, the recipe's is "
          << options.recipe.step_um << " um: " << kSayTheUnit;
  throw Error(ErrorCode::kBadInput, message.str());
}

std::string ignored_text(const std::vector<std::string>& names) {
  constexpr std::size_t kNamed = 10;
  std::string text = std::to_string(names.size()) + (names.size() == 1 ? " image file is" : " image files are") +
                     " not taken for slices: " + names.front();
  for (std::size_t i = 1; i < std::min(names.size(), kNamed); ++i) text += ", " + names[i];
  return names.size() > kNamed ? text + ", ..." : text;
}

/// The step that the names tell, where it is another than the one in use.
std::optional<double> differing_names_step_um(const ProcessOptions& options, double step_um) {
  if (options.slices.z_um.size() < 2) return std::nullopt;
  const double names_um = median_step_um(options.slices.z_um);
  if (std::abs(names_um - step_um) <= kMaxStepDifference * step_um) return std::nullopt;
  return names_um;
}

}  // namespace

double median_step_um(const std::vector<double>& z_um) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < z_um.size(); ++i) steps.push_back(std::abs(z_um[i] - z_um[i - 1]));
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return *middle;
}

Recipe recipe_of_slices(const ProcessOptions& options, const std::vector<double>& z_um) {
  Recipe recipe = options.recipe;
  recipe.slices = static_cast<int>(z_um.size());
  if (z_um.size() < 2) return recipe;
  const double step_um = median_step_um(z_um);
  const bool as_planned =
      options.recipe_plans_scan && std::abs(step_um - recipe.step_um) <= kMaxStepDifference * recipe.step_um;
  if (!as_planned) recipe.step_um = step_um;
  return recipe;
}

std::vector<Warning> check_stack(const ProcessOptions& options, const std::vector<double>& z_um) {
  const Recipe& recipe = options.recipe;
  require_enough_slices(options, focus_settings(recipe_of_slices(options, z_um)), static_cast<int>(z_um.size()));
  const double step_um = median_step_um(z_um);
  require_plausible_unit(options, step_um);
  std::vector<Warning> warnings;
  const auto warn = [&warnings](const char* code, const auto&... parts) {
    std::ostringstream text;
    (text << ... << parts);
    warnings.push_back({code, text.str()});
  };
  if (!options.slices.ignored.empty()) warn("files_ignored", ignored_text(options.slices.ignored));
  if (!options.slices.doubt.empty()) warn("slice_order", options.slices.doubt);
  if (const auto names_um = differing_names_step_um(options, step_um)) {
    warn("step_differs_from_names", "the step is ", step_um, " um, the z in ", options.slices.z_from, " are ",
         *names_um, " um apart: without --z-step-um and --z-file z is taken from there");
  }
  if (options.recipe_plans_scan && z_um.size() != static_cast<std::size_t>(recipe.slices)) {
    warn("slices_differ", "there are ", z_um.size(), " slices, the recipe has ", recipe.slices);
  }
  if (options.recipe_plans_scan && std::abs(step_um - recipe.step_um) > kMaxStepDifference * recipe.step_um) {
    warn("step_differs", "the step is ", step_um, " um, the recipe's is ", recipe.step_um, " um");
  }
  const double range_um = std::abs(z_um.back() - z_um.front());
  if (range_um < recipe.curve_width_um) {
    warn("range_short", "the slices span ", range_um, " um, less than the width of the focus curve, ",
         recipe.curve_width_um, " um: no peak is bracketed well; check the unit of z, or take more slices");
  }
  if (options.z_unit_assumed && (step_um < kMinUsualStep_um || step_um > kMaxUsualStep_um)) {
    warn("z_unit_doubtful", std::get<ZFile>(options.z).path.string(), ": the step is ", step_um, " um: ", kSayTheUnit);
  }
  return warnings;
}

}  // namespace fvd::ctl
