#include <array>
#include <optional>
#include <string>
#include <utility>
#include <variant>

#include "core/metrology/step/groove_layout.hpp"
#include "core/metrology/step/groove_step.hpp"
#include "core/metrology/step/step_parts.hpp"

namespace fvd::metrology {
namespace {

constexpr std::size_t kLeastTraces = 5;  // ISO 5436-1:2000, 7.1

/// The height in one strip; absent where it has too few points.
std::optional<StepValue> height_in(const HeightField& field, const GrooveLayout& layout, const GrooveStrip& strip,
                                   double min_valid_fraction, double sign) {
  const std::array<StepRegion, 3> regions = count_regions(field, layout, strip);
  if (refused_for_holes(regions, min_valid_fraction).has_value()) return std::nullopt;
  const PointGroups groups = groove_groups(field, layout, strip);
  const auto levels = JointLevels::fit(field, groups, layout.axes_of(strip));
  if (!levels.has_value()) return std::nullopt;
  return perpendicular_step(field, groups, *levels, kShoulders, kBottom, layout.along_axis(), sign);
}

/// Traces and their mean.
void measure_traces(const HeightField& field, const GrooveLayout& layout, double min_valid_fraction, double sign,
                    GrooveStep& groove) {
  std::vector<StepValue> values;
  for (const GrooveStrip& strip : layout.strips) {
    auto value = height_in(field, layout, strip, min_valid_fraction, sign);
    if (!value.has_value()) {
      ++groove.traces.left_out;
      continue;
    }
    const double slope = layout.across == Across::kX ? value->slope_x : value->slope_y;
    groove.traces.each.push_back({strip.from_um, strip.to_um, value->height_um, slope, value->points});
    values.push_back(std::move(*value));
  }
  if (values.size() < kLeastTraces) return;
  summarize(groove.traces);
  StepValue& mean = groove.mean;
  mean.height_um = groove.traces.mean_um;
  mean.weights = empty_weights(field, layout);
  const double share = 1.0 / static_cast<double>(values.size());
  for (const StepValue& value : values) {
    mean.vertical_um += share * value.vertical_um;
    mean.slope_x += share * value.slope_x;
    mean.slope_y += share * value.slope_y;
    mean.points += value.points;
    add_scaled(value.weights, share, mean.weights);
  }
  mean.noise = linear_noise(field, mean.weights);
}

}  // namespace

StepOutcome<GrooveStep> iso5436_a1(const HeightField& field, const GrooveSettings& settings) {
  StepOutcome<GrooveLayout> laid_out = lay_out_groove(field, settings);
  if (auto* refusal = std::get_if<StepRefusal>(&laid_out)) return std::move(*refusal);
  const GrooveLayout& layout = std::get<GrooveLayout>(laid_out);

  GrooveStep groove;
  groove.edges = layout.edges;
  groove.edges_given = layout.edges_given;
  groove.regions = count_regions(field, layout, layout.band);
  if (auto refusal = refused_for_holes(groove.regions, settings.min_valid_fraction)) return std::move(*refusal);
  const PointGroups groups = groove_groups(field, layout, layout.band);
  const auto levels = JointLevels::fit(field, groups, layout.axes_of(layout.band));
  if (!levels.has_value()) {
    return StepRefusal{StepRefusalCode::kNoSlope, "the groove's regions do not define a plane", std::nullopt};
  }
  const double sign = levels->difference_um(kShoulders, kBottom) < 0.0 ? -1.0 : 1.0;
  groove.sign = sign < 0.0 ? GrooveSign::kRidge : GrooveSign::kGroove;
  groove.areal = perpendicular_step(field, groups, *levels, kShoulders, kBottom, layout.axes_of(layout.band), sign);
  groove.areal.noise = linear_noise(field, groove.areal.weights);
  groove.correlation_factor = levels->correlation_factor(kShoulders, kBottom);
  groove.plain_means_um =
      sign * (0.5 * (groove.regions[0].mean_z_um + groove.regions[1].mean_z_um) - groove.regions[2].mean_z_um);

  measure_traces(field, layout, settings.min_valid_fraction, sign, groove);
  if (groove.traces.each.size() < kLeastTraces) {
    return StepRefusal{StepRefusalCode::kTooFewTraces,
                       std::to_string(groove.traces.each.size()) + " of " + std::to_string(layout.strips.size()) +
                           " traces have enough points, and five are asked for",
                       static_cast<double>(groove.traces.each.size())};
  }
  return groove;
}

}  // namespace fvd::metrology
