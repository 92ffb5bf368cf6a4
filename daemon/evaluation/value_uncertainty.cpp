#include "daemon/evaluation/value_uncertainty.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <sstream>
#include <utility>
#include <vector>

#include "core/metrology/uncertainty/decision.hpp"
#include "daemon/evaluation/value_names.hpp"

namespace fvd {

namespace {

constexpr std::size_t kLeastSamples = 3;
constexpr int kBandRows = 256;

/// A stage that stood still or went back between two samples has no curve that a derivative could be taken of.
bool rise_or_fall(const std::vector<CurveSample>& samples) {
  const bool rising = samples.back().z_um > samples.front().z_um;
  return std::adjacent_find(samples.begin(), samples.end(), [rising](const CurveSample& a, const CurveSample& b) {
           return rising ? !(b.z_um > a.z_um) : !(b.z_um < a.z_um);
         }) == samples.end();
}

bool are_known(const EvaluationContext& context) {
  return context.samples.size() >= kLeastSamples && context.curve_width_um > 0.0 && rise_or_fall(context.samples);
}

metrology::DecisionRule rule_of(const PlannedDecision& decision) {
  if (decision.rule == "simple") return metrology::DecisionRule::kSimple;
  if (decision.rule == "guard_U") return metrology::DecisionRule::kGuardU;
  return metrology::DecisionRule::kIso14253;
}

UncertaintyLine line_of(const metrology::BudgetEntry& entry) {
  UncertaintyLine line;
  line.source = entry.source;
  line.type = entry.type == metrology::UncertaintyType::kA ? "A" : "B";
  line.u = entry.contribution();
  if (std::isfinite(entry.dof)) line.dof = entry.dof;
  line.points_as_one = entry.points_as_one;
  return line;
}

void warn_of_tolerance(const EvaluatedValue& value, std::vector<EvaluationWarning>& warnings) {
  std::ostringstream text;
  text.precision(3);
  text << "u is " << *value.u << " " << value.unit << ", more than a third of the tolerance of "
       << *value.limits->upper - *value.limits->lower << " " << value.unit
       << ": few parts can be told to be good or bad";
  warnings.push_back({"u_above_third_of_tolerance", text.str()});
}

}  // namespace

void add_noise(const std::optional<metrology::LinearNoise>& noise, metrology::Budget& budget) {
  if (!noise) {
    budget.not_evaluated.emplace_back("noise");
    return;
  }
  metrology::BudgetEntry entry;
  entry.source = "noise";
  entry.type = metrology::UncertaintyType::kA;
  entry.u = noise->u;
  entry.points_as_one = noise->points_as_one;
  budget.entries.push_back(entry);
}

std::optional<SliceSensitivity> slice_sensitivity_of(const EvaluationContext& context) {
  if (!are_known(context)) return std::nullopt;
  std::vector<double> z_um;
  for (const CurveSample& sample : context.samples) z_um.push_back(sample.z_um);
  return std::make_optional<SliceSensitivity>(z_um, context.curve_width_um);
}

void add_slice_z(const MeasurementInput& input, const metrology::WeightMap& map, metrology::Budget& budget) {
  if (input.slices == nullptr) {
    budget.not_evaluated.emplace_back("slice_z");
    return;
  }
  std::vector<double> u_um;
  for (const CurveSample& sample : input.context.samples) u_um.push_back(sample.u_um);
  const metrology::HeightField& field = input.measured.field;
  const double z_scale = input.measured.z_scale;  // the slices' z are as the stage told them
  const int rows = map.weights.height();
  const int bands = (rows + kBandRows - 1) / kBandRows;
  std::vector<std::vector<double>> of_bands(static_cast<std::size_t>(bands));
  const auto one_band = [&](int band) {
    std::vector<double> weights(input.slices->bins() + 1, 0.0);  // the last: outside of the range
    for (int row = band * kBandRows; row < std::min((band + 1) * kBandRows, rows); ++row) {
      const double* weight = map.weights.row(row);
      const double* z = field.z_um.row(map.top + row) + map.left;
      for (int column = 0; column < map.weights.width(); ++column) {
        if (weight[column] == 0.0 || std::isnan(z[column])) continue;
        weights[input.slices->bin_of(z[column] * z_scale)] += weight[column];
      }
    }
    of_bands[static_cast<std::size_t>(band)] = std::move(weights);
  };
  if (input.pool != nullptr) {
    input.pool->run(bands, std::ref(one_band));
  } else {
    for (int band = 0; band < bands; ++band) one_band(band);
  }
  std::vector<double> weights(input.slices->bins(), 0.0);
  for (const std::vector<double>& band : of_bands) {
    for (std::size_t bin = 0; bin < weights.size(); ++bin) weights[bin] += band[bin] / z_scale;
  }
  budget.entries.push_back(metrology::slice_z_entry(input.slices->of(weights, input.pool), u_um));
}

void note_not_evaluated(const metrology::Budget& budget, EvaluatedMeasurement& made) {
  for (const std::string& source : budget.not_evaluated) {
    const bool is_new =
        std::find(made.not_evaluated.begin(), made.not_evaluated.end(), source) == made.not_evaluated.end();
    if (is_new) made.not_evaluated.push_back(source);
  }
}

EvaluatedValue judged_value(const ValueInput& input, const std::string& key, const PlannedMeasurement& planned,
                            const PlannedDecision& decision) {
  EvaluatedValue value;
  value.value = input.value;
  value.unit = unit_of_key(key);
  value.reason = input.reason;
  std::optional<metrology::CombinedUncertainty> uncertainty;
  if (input.value) uncertainty = metrology::combined(input.budget);
  if (uncertainty) {
    value.u = uncertainty->u;
    value.expanded_u = uncertainty->expanded;
    value.k = uncertainty->k;
    if (std::isfinite(uncertainty->dof)) value.dof = uncertainty->dof;
    value.u_method = input.u_method;
    for (const metrology::BudgetEntry& entry : input.budget.entries) value.budget.push_back(line_of(entry));
  }
  const auto limits = planned.limits.find(key);
  if (limits == planned.limits.end()) return value;
  value.limits = limits->second;
  const metrology::DecisionRule rule = input.exact ? metrology::DecisionRule::kSimple : rule_of(decision);
  const metrology::Decision decided =
      metrology::decide(input.value, uncertainty, limits->second, {rule, decision.probability}, input.below_noise);
  value.verdict = decided.verdict;
  if (input.below_noise && decided.verdict == Verdict::kFail) {
    value.verdict = Verdict::kUncertain;  // the noise itself may be what is too rough
    value.warnings.push_back(
        {"below_noise", "is below twice the noise floor, which raises it: an upper limit cannot fail"});
  }
  value.probability = decided.conformity;
  if (decided.u_above_third_of_tolerance) warn_of_tolerance(value, value.warnings);
  if (decided.held_back_below_noise) {
    value.warnings.push_back({"below_noise", "is below twice the noise floor, so that a lower limit cannot pass"});
  }
  if (input.value && !uncertainty && rule != metrology::DecisionRule::kSimple) {
    value.warnings.push_back({"no_uncertainty", "U is not known, so that limits cannot be judged"});
  }
  return value;
}

}  // namespace fvd
