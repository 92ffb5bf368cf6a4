#include "core/metrology/step/region_step.hpp"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <sstream>
#include <string>

#include "core/base/error.hpp"
#include "core/metrology/step/step_value.hpp"

namespace fvd::metrology {

namespace {

constexpr std::size_t kMostRegions = 200;
constexpr double kSuggestAbove = 3.0;

struct Grouped {
  PointGroups groups;
  std::vector<StepRegion> regions;
};

StepRefusal overlap(const std::string& first, const std::string& second) {
  return {StepRefusalCode::kOverlap, "the regions " + first + " and " + second + " share points", std::nullopt};
}

StepRefusal too_few(const StepRegion& region, double min_valid_fraction) {
  std::ostringstream text;
  text.precision(3);
  if (region.asked == 0) {
    text << "the region " << region.name << " has no point in the field of view";
    return {StepRefusalCode::kOutside, text.str(), std::nullopt};
  }
  text << "of the region " << region.name << " only " << 100.0 * region.valid_fraction() << " % of " << region.asked
       << " points are valid; " << 100.0 * min_valid_fraction << " % are asked for";
  return {StepRefusalCode::kTooFewValid, text.str(), region.valid_fraction()};
}

StepOutcome<Grouped> grouped(const HeightField& field, const std::vector<NamedRegion>& named,
                             double min_valid_fraction) {
  Grouped made;
  made.groups.count = static_cast<int>(named.size());
  made.groups.group = Plane<std::uint8_t>(field.width(), field.height(), 0);
  for (const NamedRegion& one : named) made.regions.push_back({one.name, 0, 0, 0.0});
  for (std::size_t i = 0; i < named.size(); ++i) {
    StepRegion& region = made.regions[i];
    for (int row = 0; row < field.height(); ++row) {
      for (int column = 0; column < field.width(); ++column) {
        if (!is_inside(*named[i].region, column, row)) continue;
        std::uint8_t& group = made.groups.group.at(column, row);
        if (group != 0) return overlap(named[static_cast<std::size_t>(group - 1)].name, named[i].name);
        group = static_cast<std::uint8_t>(i + 1);
        ++region.asked;
        if (field.is_hole(column, row)) continue;
        ++region.points;
        region.mean_z_um += field.z_um.at(column, row);
      }
    }
    if (region.points == 0 || region.valid_fraction() < min_valid_fraction) return too_few(region, min_valid_fraction);
    region.mean_z_um /= region.points;
  }
  return made;
}

StepRefusal no_slope() {
  return {StepRefusalCode::kNoSlope, "the regions do not tell the slope: their points lie on one line", std::nullopt};
}

}  // namespace

StepOutcome<RegionStep> step_between(const HeightField& field, const NamedRegion& lower, const NamedRegion& upper,
                                     StepSlope slope, double min_valid_fraction) {
  auto outcome = grouped(field, {lower, upper}, min_valid_fraction);
  if (auto* refusal = std::get_if<StepRefusal>(&outcome)) return *refusal;
  const Grouped& found = std::get<Grouped>(outcome);
  std::vector<int> from;
  if (slope == StepSlope::kFromLower) from = {1};
  if (slope == StepSlope::kFromUpper) from = {2};
  const SlopeAxes axes = slope == StepSlope::kFixed ? SlopeAxes::kNone : SlopeAxes::kBoth;
  const auto levels = JointLevels::fit(field, found.groups, axes, from);
  if (!levels) return no_slope();
  RegionStep step;
  step.value = step_value(field, found.groups, *levels, 2, 1);
  step.slope = slope;
  step.lower = found.regions[0];
  step.upper = found.regions[1];
  step.correlation_factor = levels->correlation_factor(2, 1);
  if (step.correlation_factor > kSuggestAbove) {
    std::ostringstream text;
    text.precision(3);
    text << "slope and step are fitted together, which makes the step's error " << step.correlation_factor
         << " times that of a known slope: level the surface by a larger reference region and use slope fixed";
    step.suggestion = text.str();
  }
  return step;
}

StepOutcome<Levels> levels(const HeightField& field, const std::vector<NamedRegion>& regions,
                           double min_valid_fraction) {
  if (regions.size() < 2 || regions.size() > kMostRegions) {
    throw Error(ErrorCode::kBadInput, std::to_string(regions.size()) + " regions; levels need 2 to 200");
  }
  auto outcome = grouped(field, regions, min_valid_fraction);
  if (auto* refusal = std::get_if<StepRefusal>(&outcome)) return *refusal;
  const Grouped& found = std::get<Grouped>(outcome);
  const auto fit = JointLevels::fit(field, found.groups, SlopeAxes::kBoth);
  if (!fit) return no_slope();
  Levels made;
  made.regions = found.regions;
  made.slope_x = fit->slope_x();
  made.slope_y = fit->slope_y();
  const int count = static_cast<int>(regions.size());
  for (int lower = 0; lower < count; ++lower) {
    for (int upper = lower + 1; upper < count; ++upper) {
      made.differences.push_back({lower, upper, step_value(field, found.groups, *fit, upper + 1, lower + 1),
                                  fit->correlation_factor(upper + 1, lower + 1)});
    }
  }
  return made;
}

}  // namespace fvd::metrology
