#include "daemon/evaluation/instrument_budget.hpp"

#include <algorithm>
#include <cmath>

#include "daemon/evaluation/value_names.hpp"

namespace fvd {

namespace {

using metrology::Budget;
using metrology::BudgetEntry;
using metrology::UncertaintyType;

constexpr double kReference_c = 20.0;  ///< ISO 1:2022
constexpr double kPi = 3.14159265358979323846;
const double kRectangular = std::sqrt(3.0);

bool is_step(const PlannedMeasurement& planned) {
  return planned.kind == "step_height" || planned.kind == "step_between" || planned.kind == "levels";
}

bool is_texture(const PlannedMeasurement& planned) { return planned.kind == "areal" || planned.kind == "profile"; }

bool is_edge(const PlannedMeasurement& planned) { return planned.kind == "cutting_edge"; }

const Repeatability* repeatability_of(const MeasurementInput& input, const std::string& key) {
  const auto found = input.context.repeatability.find(input.name + "." + key);
  return found == input.context.repeatability.end() ? nullptr : &found->second;
}

void add(const char* source, double u, Budget& budget) {
  BudgetEntry entry;
  entry.source = source;
  entry.u = u;
  budget.entries.push_back(entry);
}

void add_repeatability(const Repeatability& found, Budget& budget) {
  double explained = 0.0;
  for (const BudgetEntry& entry : budget.entries) {
    if (entry.type == UncertaintyType::kA) explained += entry.contribution() * entry.contribution();
  }
  BudgetEntry entry;
  entry.source = "repeatability";
  entry.type = UncertaintyType::kA;
  entry.u = std::sqrt(std::max(0.0, found.sd * found.sd - explained));
  entry.dof = found.dof;
  budget.entries.push_back(entry);
}

double relative_lateral(const LateralConstants& constants, const metrology::HeightField& field) {
  const double u =
      std::max(constants.u_pitch_x_um / constants.pitch_x_um, constants.u_pitch_y_um / constants.pitch_y_um);
  const double away = std::max(std::abs(field.pitch_x_um / constants.pitch_x_um - 1.0),
                               std::abs(field.pitch_y_um / constants.pitch_y_um - 1.0));
  return std::hypot(u, away / kRectangular);
}

/// One step of known height has no residual, which is not to say that the axis is straight.
bool knows_linearity(const ZConstants& z) { return z.linearity_um > 0.0; }
bool knows_lead(const ZConstants& z) { return z.lead_amplitude_um > 0.0 && z.lead_um > 0.0; }

/// Steps lie between two places: what the axis and the flat do from place to place.
void add_places(const MeasurementInput& input, double size, Budget& budget) {
  const Calibration& calibration = *input.context.calibration;
  if (calibration.z) {
    const ZConstants& z = *calibration.z;
    if (knows_linearity(z)) add("l_z", z.linearity_um / kRectangular, budget);
    const double turns = size * z.alpha_z / z.lead_um;
    if (knows_lead(z)) add("lead", std::sqrt(2.0) * z.lead_amplitude_um * std::abs(std::sin(kPi * turns)), budget);
  }
  if (!calibration.flatness) return;
  const FlatnessConstants& flatness = *calibration.flatness;
  add("flatness",
      input.surface.reference_subtracted ? flatness.u_reference_um : flatness.flatness_um / (2.0 * kRectangular),
      budget);
}

void add_constants(const MeasurementInput& input, const ValuePowers& powers, double size, Budget& budget) {
  if (!input.context.calibration) return;
  const Calibration& calibration = *input.context.calibration;
  if (calibration.z && powers.z != 0.0 && !is_edge(input.planned)) {
    const double relative = calibration.z->u_alpha_z / calibration.z->alpha_z;
    add("alpha_z", std::abs(powers.z) * size * relative, budget);
  }
  const bool is_height = powers == ValuePowers{1.0, 0.0};
  if (is_step(input.planned) && is_height) add_places(input, size, budget);
  if (calibration.lateral && powers.xy != 0.0) {
    add("lateral", std::abs(powers.xy) * size * relative_lateral(*calibration.lateral, input.surface.field), budget);
  }
  if (calibration.texture && is_texture(input.planned) && is_height) {
    add("reproducibility", size * calibration.texture->reproducibility_percent / 100.0, budget);
  }
}

bool knows_temperature(const MeasurementInput& input) {
  return input.context.temperature_c.has_value() && input.plan.expansion_per_k.has_value();
}

}  // namespace

void add_instrument(const MeasurementInput& input, const std::string& key, ValueInput& value) {
  if (!value.value || value.exact) return;
  Budget& budget = value.budget;
  const Repeatability* const found = repeatability_of(input, key);
  // Values that never differed, as counts in disguise, would alone pass for values without error.
  if (found != nullptr && (found->sd > 0.0 || !budget.entries.empty())) {
    if (budget.entries.empty()) value.u_method = "repeated";
    add_repeatability(*found, budget);
  } else {
    budget.not_evaluated.emplace_back("repeatability");
  }
  if (budget.entries.empty()) return;
  const ValuePowers powers = value_powers(input.planned.kind, key);
  const double size = std::abs(*value.value);
  add_constants(input, powers, size, budget);
  if (knows_temperature(input) && powers.z + powers.xy != 0.0) {
    const double expansion = *input.plan.expansion_per_k * std::abs(*input.context.temperature_c - kReference_c);
    add("temperature", std::abs(powers.z + powers.xy) * size * expansion / kRectangular, budget);
  }
}

std::vector<std::string> instrument_not_evaluated(const MeasurementInput& input) {
  const auto& calibration = input.context.calibration;
  const bool step = is_step(input.planned);
  const bool edge = is_edge(input.planned);
  const bool has_z = calibration && calibration->z;
  std::vector<std::string> sources;
  if (!has_z || edge) sources.emplace_back("alpha_z");
  if (!has_z || !step || !knows_linearity(*calibration->z)) sources.emplace_back("l_z");
  if (!has_z || !step || !knows_lead(*calibration->z)) sources.emplace_back("lead");
  const bool has_flatness = step ? calibration && calibration->flatness : input.surface.reference_subtracted && !edge;
  if (!has_flatness) sources.emplace_back("flatness");
  if (!step && !(calibration && calibration->lateral)) sources.emplace_back("lateral");
  if (is_texture(input.planned) && !(calibration && calibration->texture)) sources.emplace_back("reproducibility");
  if (!knows_temperature(input)) sources.emplace_back("temperature");
  return sources;
}

}  // namespace fvd
