/// Step heights: of grooves and ridges, between regions, of stairs.

#include <algorithm>
#include <cmath>
#include <iterator>
#include <sstream>
#include <utility>
#include <variant>

#include <nlohmann/json.hpp>

#include "core/metrology/step/groove_step.hpp"
#include "core/metrology/step/region_step.hpp"
#include "daemon/evaluation/instrument_budget.hpp"
#include "daemon/evaluation/measure_kinds.hpp"
#include "daemon/evaluation/measured_section.hpp"
#include "daemon/evaluation/plan_regions.hpp"
#include "daemon/evaluation/value_names.hpp"
#include "daemon/evaluation/value_uncertainty.hpp"

namespace fvd {

namespace {

using metrology::Budget;
using metrology::StepRegion;
using metrology::StepValue;
using nlohmann::ordered_json;

constexpr double kWarnFactor = 3.0;

/// Steps are perpendicular to the surface. Where a plane was taken away before, the fit does not see its slope any
/// more.
double to_perpendicular(const SurfaceState& surface, const StepValue& step) {
  const double x = step.slope_x + surface.removed_slope_x;
  const double y = step.slope_y + surface.removed_slope_y;
  const double seen = 1.0 + step.slope_x * step.slope_x + step.slope_y * step.slope_y;
  return std::sqrt(seen / (1.0 + x * x + y * y));
}

/// Adds a height with its budget.
void add_height(const MeasurementInput& input, const std::string& key, const StepValue& step,
                EvaluatedMeasurement& made) {
  ValueInput value;
  const double factor = to_perpendicular(input.surface, step);
  value.value = factor * step.height_um;
  value.u_method = "linear";
  add_noise(step.noise, value.budget);
  if (step.noise) {
    add_slice_z(input, step.weights, value.budget);
  } else {
    value.budget.not_evaluated.emplace_back("slice_z");  // alone it would pass for all of U
  }
  for (metrology::BudgetEntry& entry : value.budget.entries) entry.sensitivity *= factor;
  add_instrument(input, key, value);
  note_not_evaluated(value.budget, made);
  made.values[key] = judged_value(value, key, input.planned, input.plan.decision);
}

/// A value that only tells something: no uncertainty but what a gauge study found.
void add_figure(const MeasurementInput& input, const std::string& key, double figure, EvaluatedMeasurement& made) {
  ValueInput value;
  value.value = figure;
  add_instrument(input, key, value);
  note_not_evaluated(value.budget, made);
  made.values[key] = judged_value(value, key, input.planned, input.plan.decision);
}

ordered_json regions_json(const StepRegion* first, const StepRegion* last) {
  ordered_json regions = ordered_json::object();
  for (const StepRegion* region = first; region != last; ++region) {
    regions[region->name] = {
        {"points", region->points}, {"valid_fraction", region->valid_fraction()}, {"mean_z_um", region->mean_z_um}};
  }
  return regions;
}

void note_regions(const StepRegion* first, const StepRegion* last, EvaluatedMeasurement& made) {
  made.valid_fraction = 1.0;
  for (const StepRegion* region = first; region != last; ++region) {
    made.points += region->points;
    made.valid_fraction = std::min(made.valid_fraction, region->valid_fraction());
  }
}

ordered_json traces_json(const metrology::StepTraces& traces) {
  ordered_json json{{"mean_um", traces.mean_um}, {"sd_um", traces.sd_um}, {"left_out", traces.left_out}};
  for (const metrology::StepTrace& trace : traces.each) {
    json["each"].push_back({{"from_um", trace.from_um},
                            {"to_um", trace.to_um},
                            {"height_um", trace.height_um},
                            {"slope", trace.slope},
                            {"points", trace.points}});
  }
  return json;
}

ordered_json edges_json(const metrology::GrooveEdges& edges, bool given) {
  return {{"from_um", edges.left_um}, {"to_um", edges.right_um}, {"width_um", edges.width_um()}, {"given", given}};
}

metrology::GrooveSettings groove_settings(const PlannedMeasurement& planned) {
  metrology::GrooveSettings settings;
  settings.across = planned.across == "y" ? metrology::Across::kY : metrology::Across::kX;
  if (planned.band_from_to_um.size() == 2) {
    settings.band = metrology::FromTo{planned.band_from_to_um[0], planned.band_from_to_um[1]};
  }
  if (planned.edges_um.size() == 2) settings.edges = metrology::GrooveEdges{planned.edges_um[0], planned.edges_um[1]};
  settings.traces = planned.traces;
  settings.min_valid_fraction = planned.min_valid_fraction;
  return settings;
}

const char* sign_name(metrology::GrooveSign sign) {
  return sign == metrology::GrooveSign::kGroove ? "groove" : "ridge";
}

void refuse(const metrology::StepRefusal& refusal, EvaluatedMeasurement& made) {
  made.reason = refusal.text;
  if (refusal.code == metrology::StepRefusalCode::kTooFewValid) made.reason_code = evaluation_code::kTooFewValid;
  if (refusal.code == metrology::StepRefusalCode::kOutside) made.reason_code = evaluation_code::kRegionOutside;
}

/// A trace has no slope along the groove: where the surface is tilted that way, its height is too large.
void warn_of_tilt_along(EvaluatedMeasurement& made) {
  EvaluatedValue& by_traces = made.values.at("height_um");
  const EvaluatedValue& areal = made.values.at("height_areal_um");
  const double difference_um = *by_traces.value - *areal.value;
  if (!by_traces.expanded_u || std::abs(difference_um) <= *by_traces.expanded_u) return;
  std::ostringstream text;
  text.precision(3);
  text << "the surface is tilted along the groove, which traces do not see: height_um is " << difference_um
       << " um off; read height_areal_um, or put the part upright";
  made.warnings.push_back({"tilt_along", text.str()});
  if (by_traces.verdict == Verdict::kPass || by_traces.verdict == Verdict::kFail)
    by_traces.verdict = Verdict::kUncertain;
}

void measure_flat_bottom(const MeasurementInput& input, EvaluatedMeasurement& made) {
  const metrology::GrooveSettings settings = groove_settings(input.planned);
  const auto outcome = metrology::iso5436_a1(input.surface.field, settings);
  if (const auto* refusal = std::get_if<metrology::StepRefusal>(&outcome)) return refuse(*refusal, made);
  const auto& groove = std::get<metrology::GrooveStep>(outcome);
  add_height(input, "height_um", groove.mean, made);
  add_height(input, "height_areal_um", groove.areal, made);
  warn_of_tilt_along(made);
  add_figure(input, "plain_means_um", groove.plain_means_um, made);
  add_figure(input, "width_um", groove.edges.width_um(), made);
  note_regions(groove.regions.data(), groove.regions.data() + groove.regions.size(), made);
  made.details =
      ordered_json{{"sign", sign_name(groove.sign)},
                   {"edges", edges_json(groove.edges, groove.edges_given)},
                   {"traces", traces_json(groove.traces)},
                   {"slope_x", groove.areal.slope_x},
                   {"slope_y", groove.areal.slope_y},
                   {"correlation_factor", groove.correlation_factor},
                   {"regions", regions_json(groove.regions.data(), groove.regions.data() + groove.regions.size())}}
          .dump();
  made.cross_section = groove_section(input.surface.field, settings, groove.edges);
}

void measure_rounded_bottom(const MeasurementInput& input, EvaluatedMeasurement& made) {
  const metrology::GrooveSettings settings = groove_settings(input.planned);
  const auto outcome = metrology::iso5436_a2(input.surface.field, settings);
  if (const auto* refusal = std::get_if<metrology::StepRefusal>(&outcome)) return refuse(*refusal, made);
  const auto& groove = std::get<metrology::RoundedGroove>(outcome);
  add_height(input, "height_um", groove.mean, made);
  add_figure(input, "width_um", groove.edges.width_um(), made);
  add_figure(input, "bottom_radius_um", groove.radius_um, made);
  note_regions(groove.regions.data(), groove.regions.data() + groove.regions.size(), made);
  made.details =
      ordered_json{{"sign", sign_name(groove.sign)},
                   {"edges", edges_json(groove.edges, groove.edges_given)},
                   {"traces", traces_json(groove.traces)},
                   {"regions", regions_json(groove.regions.data(), groove.regions.data() + groove.regions.size())}}
          .dump();
  made.cross_section = groove_section(input.surface.field, settings, groove.edges);
}

metrology::StepSlope slope_of(const std::string& name) {
  if (name == "from_lower") return metrology::StepSlope::kFromLower;
  if (name == "from_upper") return metrology::StepSlope::kFromUpper;
  if (name == "fixed") return metrology::StepSlope::kFixed;
  return metrology::StepSlope::kCommonPlane;
}

}  // namespace

EvaluatedMeasurement measure_step_height(const MeasurementInput& input) {
  EvaluatedMeasurement made;
  made.method = input.planned.method.empty() ? "iso5436_a1" : input.planned.method;
  made.main_value = "height_um";
  if (made.method == "iso5436_a2") {
    measure_rounded_bottom(input, made);
  } else {
    measure_flat_bottom(input, made);
  }
  return made;
}

EvaluatedMeasurement measure_step_between(const MeasurementInput& input) {
  EvaluatedMeasurement made;
  made.method = input.planned.slope;
  made.main_value = "height_um";
  const metrology::HeightField& field = input.surface.field;
  const metrology::Region lower = region_points(input.plan, input.planned.lower, field);
  const metrology::Region upper = region_points(input.plan, input.planned.upper, field);
  const auto outcome =
      metrology::step_between(field, {input.planned.lower, &lower}, {input.planned.upper, &upper},
                              slope_of(input.planned.slope), input.planned.min_valid_fraction, input.pool);
  if (const auto* refusal = std::get_if<metrology::StepRefusal>(&outcome)) {
    refuse(*refusal, made);
    return made;
  }
  const auto& step = std::get<metrology::RegionStep>(outcome);
  add_height(input, "height_um", step.value, made);
  const std::array regions{step.lower, step.upper};
  note_regions(regions.data(), regions.data() + regions.size(), made);
  made.details = ordered_json{{"slope_x", step.value.slope_x},
                              {"slope_y", step.value.slope_y},
                              {"correlation_factor", step.correlation_factor},
                              {"regions", regions_json(regions.data(), regions.data() + regions.size())}}
                     .dump();
  const std::array sections{SectionRegion{input.planned.lower, &lower}, SectionRegion{input.planned.upper, &upper}};
  made.cross_section = regions_section(field, sections);
  if (input.planned.slope == "fixed" && input.surface.levelled) {
    made.not_evaluated.emplace_back("levelling");
    made.warnings.push_back({"levelling_not_in_u",
                             "the slope is that of the surface's levelling, whose error U does not contain: it grows "
                             "with the distance of the regions from what was levelled by"});
  }
  if (step.correlation_factor > kWarnFactor) made.warnings.push_back({"slope_and_step_correlated", step.suggestion});
  return made;
}

EvaluatedMeasurement measure_levels(const MeasurementInput& input) {
  EvaluatedMeasurement made;
  made.main_value = level_value_key(input.planned.regions[1], input.planned.regions[0]);
  const metrology::HeightField& field = input.surface.field;
  std::vector<metrology::Region> points;
  points.reserve(input.planned.regions.size());
  std::vector<metrology::NamedRegion> named;
  for (const std::string& name : input.planned.regions) {
    points.push_back(region_points(input.plan, name, field));
    named.push_back({name, &points.back()});
  }
  const auto outcome = metrology::levels(field, named, input.planned.min_valid_fraction, input.pool);
  if (const auto* refusal = std::get_if<metrology::StepRefusal>(&outcome)) {
    refuse(*refusal, made);
    return made;
  }
  const auto& found = std::get<metrology::Levels>(outcome);
  ordered_json factors = ordered_json::object();
  for (const metrology::LevelDifference& difference : found.differences) {
    const std::string key = level_value_key(input.planned.regions[static_cast<std::size_t>(difference.upper)],
                                            input.planned.regions[static_cast<std::size_t>(difference.lower)]);
    add_height(input, key, difference.value, made);
    factors[key] = difference.correlation_factor;
  }
  const StepRegion* regions = found.regions.data();
  note_regions(regions, regions + found.regions.size(), made);
  made.details = ordered_json{{"slope_x", found.slope_x},
                              {"slope_y", found.slope_y},
                              {"correlation_factors", std::move(factors)},
                              {"regions", regions_json(regions, regions + found.regions.size())}}
                     .dump();
  std::vector<SectionRegion> sections;
  for (const metrology::NamedRegion& region : named) sections.push_back({region.name, region.region});
  made.cross_section = regions_section(field, sections);
  return made;
}

}  // namespace fvd
