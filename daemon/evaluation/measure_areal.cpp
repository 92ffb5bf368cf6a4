/// Areal texture.

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "core/metrology/areal/evaluate_areal.hpp"
#include "core/metrology/areal/height_weights.hpp"
#include "core/metrology/operations/region.hpp"
#include "core/metrology/uncertainty/monte_carlo.hpp"
#include "daemon/evaluation/instrument_budget.hpp"
#include "daemon/evaluation/measure_kinds.hpp"
#include "daemon/evaluation/noise_floor.hpp"
#include "daemon/evaluation/plan_regions.hpp"
#include "daemon/evaluation/value_names.hpp"
#include "daemon/evaluation/value_uncertainty.hpp"

namespace fvd {

namespace {

using metrology::ArealEvaluation;
using metrology::ArealParameter;
using metrology::HeightField;
using metrology::Region;
using nlohmann::ordered_json;

constexpr int kGradientMargin_px = 3;
constexpr std::uint64_t kSeed = 1;

std::vector<ArealParameter> parameters_of(const PlannedMeasurement& planned) {
  std::vector<ArealParameter> parameters;
  for (const std::string& name : planned.parameters)
    parameters.push_back(metrology::find_areal_parameter(name).value());
  return parameters;
}

/// Parameters whose noise no derivative tells, and that a limit makes worth 200 draws.
std::vector<ArealParameter> drawn_parameters(const MeasurementInput& input, const std::vector<ArealParameter>& all) {
  std::vector<ArealParameter> drawn;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const bool limited = input.planned.limits.contains(areal_value_key(input.planned.parameters[i]));
    const bool linear = all[i] <= ArealParameter::kSz;
    if (limited && !linear) drawn.push_back(all[i]);
  }
  return drawn;
}

class ArealUncertainty {
 public:
  ArealUncertainty(const MeasurementInput& input, const Region& region, const metrology::ArealSettings& settings,
                   const std::vector<ArealParameter>& all, const metrology::HeightStatistics& statistics)
      : input_(input), weights_(input.surface.field, region, statistics), drawn_(drawn_parameters(input, all)) {
    if (drawn_.empty() || !input.surface.field.has_sigma()) return;
    metrology::MonteCarloSettings monte_carlo;
    monte_carlo.seed = kSeed;
    monte_carlo.margin_px = kGradientMargin_px;
    const auto values = [&](const HeightField& field, const Region& of) {
      std::vector<std::optional<double>> made;
      for (const auto& value : metrology::evaluate_areal(field, of, drawn_, settings).values) {
        made.push_back(value.value);
      }
      return made;
    };
    draws_ = metrology::monte_carlo(input.surface.field, region, monte_carlo, values, input.pool);
  }

  void add_to(ValueInput& value, ArealParameter parameter) const {
    const HeightField& field = input_.surface.field;
    if (const auto weights = weights_.of(parameter)) {
      value.u_method = "linear";
      add_noise(field.has_sigma() ? metrology::linear_noise(field, *weights, input_.pool) : std::nullopt, value.budget);
      if (field.has_sigma()) add_slice_z(input_, *weights, value.budget);
      return;
    }
    const auto place = std::find(drawn_.begin(), drawn_.end(), parameter);
    if (!draws_ || place == drawn_.end()) return;
    const auto& drawn = draws_->values[static_cast<std::size_t>(place - drawn_.begin())];
    if (!drawn.u) return;
    metrology::BudgetEntry entry;
    entry.source = "noise";
    entry.type = metrology::UncertaintyType::kA;
    entry.u = *drawn.u;
    entry.dof = drawn.draws - 1;
    value.budget.entries.push_back(entry);
    value.budget.not_evaluated.emplace_back("slice_z");
    value.u_method = "monte_carlo";
  }

  [[nodiscard]] ordered_json json() const {
    if (!draws_) return nullptr;
    return {{"draws", draws_->draws}, {"seed", draws_->seed}};
  }

 private:
  const MeasurementInput& input_;
  metrology::HeightWeights weights_;
  std::vector<ArealParameter> drawn_;
  std::optional<metrology::MonteCarlo> draws_;
};

}  // namespace

EvaluatedMeasurement measure_areal(const MeasurementInput& input) {
  EvaluatedMeasurement made;
  made.main_value = areal_value_key(input.planned.parameters.front());
  made.region = input.planned.region;
  const HeightField& field = input.surface.field;
  const Region region = region_points(input.plan, input.planned.region, field);
  if (!region.empty() && metrology::count_points(region) == 0) {
    made.reason = "the region " + input.planned.region + " has no point in the field of view";
    made.reason_code = evaluation_code::kRegionOutside;
    return made;
  }
  const NoiseFloor floor = noise_floor(input, region);
  metrology::ArealSettings settings;
  settings.noise_floor_um = floor.sq_um;
  std::vector<ArealParameter> parameters = parameters_of(input.planned);
  parameters.push_back(ArealParameter::kSq);
  const ArealEvaluation found = metrology::evaluate_areal(field, region, parameters, settings);
  parameters.pop_back();
  made.points = static_cast<std::int64_t>(found.points);
  made.valid_fraction = found.valid_fraction();
  made.reason = too_few_valid(found.valid_fraction(), input.planned);
  if (!made.reason.empty()) made.reason_code = evaluation_code::kTooFewValid;
  const std::optional<double> sq_um = found.values.back().value;
  const bool below_noise = is_below_noise(sq_um, floor);
  made.not_evaluated = texture_not_evaluated(input);
  const ArealUncertainty uncertainty(input, region, settings, parameters, found.statistics);
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const std::string key = areal_value_key(input.planned.parameters[i]);
    ValueInput value;
    value.value = found.values[i].value;
    value.reason = found.values[i].reason;
    value.below_noise = below_noise;
    if (value.value) uncertainty.add_to(value, parameters[i]);
    add_instrument(input, key, value);
    note_not_evaluated(value.budget, made);
    EvaluatedValue judged = judged_value(value, key, input.planned, input.plan.decision);
    if (found.values[i].tie) judged.warnings.push_back({"tie", "two candidates are equal; the first was taken"});
    made.values[key] = std::move(judged);
  }
  if (below_noise) warn_below_noise(*sq_um, floor, made);
  ordered_json details = texture_conditions(input, floor);
  details["mean_um"] = found.mean_um;
  details["monte_carlo"] = uncertainty.json();
  made.details = details.dump();
  return made;
}

}  // namespace fvd
