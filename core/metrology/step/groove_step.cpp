/// Flat bottom: ISO 5436-1 type A1.

#include "core/metrology/step/groove_step.hpp"

#include <cmath>
#include <string>
#include <utility>

#include "core/metrology/step/groove_layout.hpp"
#include "core/metrology/step/step_value.hpp"
#include "core/metrology/step/trace_mean.hpp"

namespace fvd::metrology {

namespace {

constexpr std::size_t kLeastTraces = 5;
constexpr int kLand = 1;
constexpr int kBottom = 2;

/// A strip as one trace; nothing where too few of its points are valid.
std::optional<MeasuredTrace> measured(const HeightField& field, const GrooveLayout& layout, const RowRange& strip,
                                      double min_valid_fraction, double sign) {
  if (too_few_valid(groove_counts(field, layout, strip), min_valid_fraction)) return std::nullopt;
  const PointGroups groups = groove_groups(field, layout, strip);
  const SlopeAxes axes = strip.rows() > 1 ? SlopeAxes::kBoth : SlopeAxes::kX;
  const auto levels = JointLevels::fit(field, groups, axes);
  if (!levels) return std::nullopt;
  MeasuredTrace made;
  const double a = levels->slope_x();
  const double root = std::sqrt(1.0 + a * a);
  StepValue& value = made.value;
  value.vertical_um = sign * levels->difference_um(kLand, kBottom);
  value.height_um = value.vertical_um / root;
  value.slope_x = a;
  value.slope_y = levels->slope_y();
  value.points = levels->points(kLand) + levels->points(kBottom);
  value.weights =
      levels->weights(field, groups, kLand, kBottom, sign / root, {-value.vertical_um * a / (root * root * root), 0.0});
  made.trace = {strip.first * field.pitch_y_um, (strip.last + 1) * field.pitch_y_um, value.height_um, a, value.points};
  return made;
}

StepOutcome<GrooveStep> along_x(const HeightField& field, const GrooveSettings& settings) {
  auto outcome = lay_out_groove(field, settings);
  if (auto* refusal = std::get_if<StepRefusal>(&outcome)) return *refusal;
  const GrooveLayout& layout = std::get<GrooveLayout>(outcome);
  GrooveStep step;
  step.edges = layout.edges;
  step.edges_given = layout.edges_given;
  step.regions = groove_counts(field, layout, layout.band);
  if (auto refusal = too_few_valid(step.regions, settings.min_valid_fraction)) return *refusal;
  const PointGroups groups = groove_groups(field, layout, layout.band);
  const auto levels = JointLevels::fit(field, groups, SlopeAxes::kBoth);
  if (!levels) {
    return StepRefusal{StepRefusalCode::kNoSlope, "the points of the band do not tell its slope", std::nullopt};
  }
  const double sign = levels->difference_um(kLand, kBottom) < 0.0 ? -1.0 : 1.0;
  step.sign = sign < 0.0 ? GrooveSign::kRidge : GrooveSign::kGroove;
  step.areal = step_value(field, groups, *levels, kLand, kBottom, sign);
  step.correlation_factor = levels->correlation_factor(kLand, kBottom);
  step.plain_means_um =
      sign * (0.5 * (step.regions[0].mean_z_um + step.regions[1].mean_z_um) - step.regions[2].mean_z_um);
  std::vector<MeasuredTrace> traces;
  for (const RowRange& strip : layout.strips) {
    auto trace = measured(field, layout, strip, settings.min_valid_fraction, sign);
    if (trace) traces.push_back(std::move(*trace));
  }
  if (traces.size() < kLeastTraces) {
    return StepRefusal{StepRefusalCode::kTooFewTraces,
                       "only " + std::to_string(traces.size()) + " of " + std::to_string(layout.strips.size()) +
                           " traces have enough valid points; ISO 5436-1 asks for five",
                       static_cast<double>(traces.size())};
  }
  step.traces = list_of(traces, static_cast<int>(layout.strips.size() - traces.size()));
  step.mean = mean_of(field, traces);
  return step;
}

}  // namespace

StepOutcome<GrooveStep> iso5436_a1(const HeightField& field, const GrooveSettings& settings) {
  if (settings.across == Across::kX) return along_x(field, settings);
  auto outcome = along_x(transposed(field), settings);
  if (auto* step = std::get_if<GrooveStep>(&outcome)) {
    turn_back(step->mean);
    turn_back(step->areal);
  }
  return outcome;
}

}  // namespace fvd::metrology
