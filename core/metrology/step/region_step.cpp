#include "core/metrology/step/region_step.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <variant>

#include "core/base/error.hpp"
#include "core/metrology/step/joint_levels.hpp"
#include "core/metrology/step/step_parts.hpp"

namespace fvd::metrology {
namespace {

constexpr double kSuggestAbove = 3.0;
constexpr std::size_t kMostRegions = 200;  // PointGroups counts them in a byte

struct GroupedRegions {
  PointGroups groups;
  std::vector<StepRegion> regions;
};

/// A rectangle of points, last included.
struct Bounds {
  int left = INT32_MAX;
  int top = INT32_MAX;
  int right = -1;
  int bottom = -1;
};

Bounds bounds_of(const HeightField& field, std::span<const NamedRegion> regions) {
  Bounds bounds;
  for (const NamedRegion& region : regions) {
    assert(region.region != nullptr);
    const Region& mask = *region.region;
    assert(mask.empty() || (mask.width() == field.width() && mask.height() == field.height()));
    for (int row = 0; row < field.height(); ++row) {
      for (int column = 0; column < field.width(); ++column) {
        if (!is_inside(mask, column, row)) continue;
        bounds.left = std::min(bounds.left, column);
        bounds.right = std::max(bounds.right, column);
        bounds.top = std::min(bounds.top, row);
        bounds.bottom = std::max(bounds.bottom, row);
      }
    }
  }
  return bounds;
}

/// Numbers the regions' points; a refusal where one has none, two share some, or one has too few valid ones.
StepOutcome<GroupedRegions> grouped(const HeightField& field, std::span<const NamedRegion> regions,
                                    double min_valid_fraction) {
  Bounds bounds = bounds_of(field, regions);
  if (bounds.right < 0) bounds = {0, 0, -1, -1};
  GroupedRegions result;
  PointGroups& groups = result.groups;
  groups.left = bounds.left;
  groups.top = bounds.top;
  groups.count = static_cast<int>(regions.size());
  groups.group = Plane<std::uint8_t>(bounds.right - bounds.left + 1, bounds.bottom - bounds.top + 1);
  for (std::size_t i = 0; i < regions.size(); ++i) {
    StepRegion counted{regions[i].name, 0, 0, 0.0};
    double sum = 0.0;
    for (int y = 0; y < groups.group.height(); ++y) {
      for (int x = 0; x < groups.group.width(); ++x) {
        const int column = groups.left + x;
        const int row = groups.top + y;
        if (!is_inside(*regions[i].region, column, row)) continue;
        std::uint8_t& group = groups.group.at(x, y);
        if (group != 0) {
          return StepRefusal{
              StepRefusalCode::kOverlap,
              "the regions " + regions[group - std::size_t{1}].name + " and " + regions[i].name + " share points",
              std::nullopt};
        }
        group = static_cast<std::uint8_t>(i + 1);
        ++counted.asked;
        if (field.is_hole(column, row)) continue;
        ++counted.points;
        sum += field.z_um.at(column, row);
      }
    }
    if (counted.asked == 0) {
      return StepRefusal{StepRefusalCode::kOutside, "region " + counted.name + " has no point of the surface",
                         std::nullopt};
    }
    if (counted.points > 0) counted.mean_z_um = sum / counted.points;
    result.regions.push_back(std::move(counted));
  }
  if (auto refusal = refused_for_holes(result.regions, min_valid_fraction)) return std::move(*refusal);
  return result;
}

StepRefusal no_slope(const std::string& whose) {
  return {StepRefusalCode::kNoSlope, "the points of " + whose + " do not define a plane", std::nullopt};
}

constexpr int kLower = 1;
constexpr int kUpper = 2;

}  // namespace

StepOutcome<RegionStep> step_between(const HeightField& field, const NamedRegion& lower, const NamedRegion& upper,
                                     StepSlope slope, double min_valid_fraction) {
  const std::array both{lower, upper};
  StepOutcome<GroupedRegions> found = grouped(field, both, min_valid_fraction);
  if (auto* refusal = std::get_if<StepRefusal>(&found)) return std::move(*refusal);
  const GroupedRegions& points = std::get<GroupedRegions>(found);

  std::vector<int> from;
  std::string whose = lower.name + " and " + upper.name;
  if (slope == StepSlope::kFromLower) {
    from = {kLower};
    whose = lower.name;
  } else if (slope == StepSlope::kFromUpper) {
    from = {kUpper};
    whose = upper.name;
  }
  const SlopeAxes axes = slope == StepSlope::kFixed ? SlopeAxes::kNone : SlopeAxes::kBoth;
  const auto levels = JointLevels::fit(field, points.groups, axes, from);
  if (!levels.has_value()) return no_slope(whose);

  RegionStep step;
  step.slope = slope;
  step.lower = points.regions[0];
  step.upper = points.regions[1];
  step.value = perpendicular_step(field, points.groups, *levels, kUpper, kLower, axes, 1.0);
  step.value.noise = linear_noise(field, step.value.weights);
  step.correlation_factor = levels->correlation_factor(kUpper, kLower);
  if (step.correlation_factor > kSuggestAbove) {
    step.suggestion = "the slope of " + whose + " is so uncertain over the distance of the regions that the step's " +
                      "standard error is " + figure_text(step.correlation_factor) +
                      " times that of a known slope; level the surface by a reference region that reaches over both "
                      "sides of the step, and measure with a fixed slope";
  }
  return step;
}

StepOutcome<Levels> levels(const HeightField& field, const std::vector<NamedRegion>& regions,
                           double min_valid_fraction) {
  if (regions.size() < 2 || regions.size() > kMostRegions) {
    throw Error(ErrorCode::kBadInput,
                "levels are measured between 2 to 200 regions, not " + std::to_string(regions.size()));
  }
  StepOutcome<GroupedRegions> found = grouped(field, regions, min_valid_fraction);
  if (auto* refusal = std::get_if<StepRefusal>(&found)) return std::move(*refusal);
  GroupedRegions& points = std::get<GroupedRegions>(found);
  const auto fitted = JointLevels::fit(field, points.groups, SlopeAxes::kBoth);
  if (!fitted.has_value()) return no_slope("the regions");

  Levels result;
  result.slope_x = fitted->slope_x();
  result.slope_y = fitted->slope_y();
  for (int lower = 1; lower <= points.groups.count; ++lower) {
    for (int upper = lower + 1; upper <= points.groups.count; ++upper) {
      LevelDifference difference;
      difference.lower = lower - 1;
      difference.upper = upper - 1;
      difference.value = perpendicular_step(field, points.groups, *fitted, upper, lower, SlopeAxes::kBoth, 1.0);
      difference.value.noise = linear_noise(field, difference.value.weights);
      difference.correlation_factor = fitted->correlation_factor(upper, lower);
      result.differences.push_back(std::move(difference));
    }
  }
  result.regions = std::move(points.regions);
  return result;
}

}  // namespace fvd::metrology
