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
#include "core/metrology/region_bounds.hpp"
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

RegionBounds bounds_of_all(const HeightField& field, std::span<const NamedRegion> regions) {
  RegionBounds bounds{field.width(), field.height(), 0, 0};
  for (const NamedRegion& region : regions) {
    assert(region.region != nullptr);
    const Region& mask = *region.region;
    assert(mask.empty() || (mask.width() == field.width() && mask.height() == field.height()));
    const RegionBounds of_one = bounds_of(mask, field.width(), field.height());
    if (of_one.empty()) continue;
    bounds.left = std::min(bounds.left, of_one.left);
    bounds.right = std::max(bounds.right, of_one.right);
    bounds.top = std::min(bounds.top, of_one.top);
    bounds.bottom = std::max(bounds.bottom, of_one.bottom);
  }
  return bounds.empty() ? RegionBounds{} : bounds;
}

/// Numbers the points of one region in the groups; the number of a region that has one of them already, else 0.
std::uint8_t number_points(const HeightField& field, const Region& region, std::uint8_t number, PointGroups& groups,
                           StepRegion& counted) {
  double sum = 0.0;
  const int width = groups.group.width();
  for (int y = 0; y < groups.group.height(); ++y) {
    const std::uint8_t* inside = region.empty() ? nullptr : region.row(groups.top + y) + groups.left;
    const int first = inside == nullptr ? 0 : region_bounds::first_inside(inside, width);
    if (first == width) continue;
    const double* z = field.z_um.row(groups.top + y) + groups.left;
    std::uint8_t* group = groups.group.row(y);
    // A row is summed by itself, so that the sum of millions of points keeps its digits.
    double of_row = 0.0;
    int asked = 0;
    int points = 0;
    for (int x = first; x < width; ++x) {
      if (inside != nullptr && inside[x] == 0) continue;
      if (group[x] != 0) return group[x];
      group[x] = number;
      ++asked;
      const bool is_valid = z[x] == z[x];
      points += is_valid ? 1 : 0;
      of_row += is_valid ? z[x] : 0.0;
    }
    counted.asked += asked;
    counted.points += points;
    sum += of_row;
  }
  if (counted.points > 0) counted.mean_z_um = sum / counted.points;
  return 0;
}

/// Numbers the regions' points; a refusal where one has none, two share some, or one has too few valid ones.
StepOutcome<GroupedRegions> grouped(const HeightField& field, std::span<const NamedRegion> regions,
                                    double min_valid_fraction) {
  const RegionBounds bounds = bounds_of_all(field, regions);
  GroupedRegions result;
  PointGroups& groups = result.groups;
  groups.left = bounds.left;
  groups.top = bounds.top;
  groups.count = static_cast<int>(regions.size());
  groups.group = Plane<std::uint8_t>(bounds.width(), bounds.height());
  for (std::size_t i = 0; i < regions.size(); ++i) {
    StepRegion counted{regions[i].name, 0, 0, 0.0};
    const auto number = static_cast<std::uint8_t>(i + 1);
    if (const std::uint8_t other = number_points(field, *regions[i].region, number, groups, counted); other != 0) {
      return StepRefusal{
          StepRefusalCode::kOverlap,
          "the regions " + regions[other - std::size_t{1}].name + " and " + regions[i].name + " share points",
          std::nullopt};
    }
    if (counted.asked == 0) {
      return StepRefusal{StepRefusalCode::kOutside, "region " + counted.name + " has no point of the surface",
                         std::nullopt};
    }
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
                                     StepSlope slope, double min_valid_fraction, WorkerPool* pool) {
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
  step.value.noise = linear_noise(field, step.value.weights, pool);
  step.correlation_factor = levels->correlation_factor(kUpper, kLower);
  if (step.correlation_factor > kSuggestAbove) {
    step.suggestion = "the slope of " + whose + " is so uncertain over the distance of the regions that the step's " +
                      "standard error is " + figure_text(step.correlation_factor) +
                      " times that of a known slope; level the surface by a reference region that reaches over both "
                      "sides of the step, and measure with a fixed slope";
  }
  return step;
}

StepOutcome<Levels> levels(const HeightField& field, const std::vector<NamedRegion>& regions, double min_valid_fraction,
                           WorkerPool* pool) {
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
      difference.value.noise = linear_noise(field, difference.value.weights, pool);
      difference.correlation_factor = fitted->correlation_factor(upper, lower);
      result.differences.push_back(std::move(difference));
    }
  }
  result.regions = std::move(points.regions);
  return result;
}

}  // namespace fvd::metrology
