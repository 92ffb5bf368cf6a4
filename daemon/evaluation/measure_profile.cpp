/// Profiles across a surface.

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "core/base/error.hpp"
#include "core/metrology/operations/region.hpp"
#include "core/metrology/profile/profile_evaluation.hpp"
#include "core/metrology/region_bounds.hpp"
#include "core/metrology/uncertainty/monte_carlo.hpp"
#include "daemon/evaluation/instrument_budget.hpp"
#include "daemon/evaluation/measure_kinds.hpp"
#include "daemon/evaluation/measured_section.hpp"
#include "daemon/evaluation/noise_floor.hpp"
#include "daemon/evaluation/value_names.hpp"
#include "daemon/evaluation/value_uncertainty.hpp"

namespace fvd {

namespace {

using metrology::HeightField;
using metrology::Profile;
using metrology::ProfileLine;
using metrology::ProfileParameter;
using metrology::ProfileResult;
using metrology::Region;
using nlohmann::ordered_json;

constexpr std::uint64_t kSeed = 1;

ProfileLine line_of(const PlannedMeasurement& planned) {
  ProfileLine line;
  line.from_x_um = planned.from_um[0];
  line.from_y_um = planned.from_um[1];
  line.to_x_um = planned.to_um[0];
  line.to_y_um = planned.to_um[1];
  line.band_width_um = planned.band_width_um;
  return line;
}

/// The corners of the band, one pixel larger for the points that samples lie between.
Region band_region(const HeightField& field, const ProfileLine& line) {
  const double x_um = line.to_x_um - line.from_x_um;
  const double y_um = line.to_y_um - line.from_y_um;
  const double length_um = std::hypot(x_um, y_um);
  const double half_um = line.band_width_um / 2.0;
  const double left_um = std::min(line.from_x_um, line.to_x_um) - half_um * std::abs(y_um) / length_um;
  const double top_um = std::min(line.from_y_um, line.to_y_um) - half_um * std::abs(x_um) / length_um;
  const double width_um = std::abs(x_um) + 2.0 * half_um * std::abs(y_um) / length_um;
  const double height_um = std::abs(y_um) + 2.0 * half_um * std::abs(x_um) / length_um;
  return metrology::rectangle_region(metrology::grid_of(field),
                                     {left_um - field.pitch_x_um, top_um - field.pitch_y_um,
                                      width_um + 2.0 * field.pitch_x_um, height_um + 2.0 * field.pitch_y_um});
}

std::optional<metrology::MonteCarlo> drawn(const HeightField& field, const ProfileLine& line, const Region& region,
                                           const std::vector<ProfileParameter>& parameters,
                                           const metrology::ProfileSettings& settings, WorkerPool* pool) {
  if (!field.has_sigma()) return std::nullopt;
  // The line in a field that is cut to the region's rectangle.
  const metrology::RegionBounds bounds = metrology::bounds_of(region, field.width(), field.height());
  ProfileLine moved = line;
  moved.from_x_um -= bounds.left * field.pitch_x_um;
  moved.to_x_um -= bounds.left * field.pitch_x_um;
  moved.from_y_um -= bounds.top * field.pitch_y_um;
  moved.to_y_um -= bounds.top * field.pitch_y_um;
  metrology::MonteCarloSettings monte_carlo;
  monte_carlo.seed = kSeed;
  const auto values_of = [&](const HeightField& cut, const Region&) {
    std::vector<std::optional<double>> values;
    for (const auto& value :
         metrology::evaluate_profile(metrology::extract_profile(cut, moved), parameters, settings).values) {
      values.push_back(value.value);
    }
    return values;
  };
  return metrology::monte_carlo(field, region, monte_carlo, values_of, pool);
}

/// The profile, or why there is none in made.
std::optional<Profile> extracted(const HeightField& field, const ProfileLine& line, EvaluatedMeasurement& made) {
  try {
    return metrology::extract_profile(field, line);
  } catch (const Error& error) {
    made.reason = error.what();
    made.reason_code =
        error.code() == ErrorCode::kRegionOutside ? evaluation_code::kRegionOutside : evaluation_code::kInvalid;
    return std::nullopt;
  }
}

/// The root mean square of the profile that a parameter is of: what decides whether it is told from noise.
ProfileParameter root_mean_square_of(ProfileParameter parameter) {
  switch (metrology::profile_parameter_info(parameter).kind) {
    case metrology::ProfileKind::kP:
      return ProfileParameter::kPq;
    case metrology::ProfileKind::kW:
      return ProfileParameter::kWq;
    case metrology::ProfileKind::kR:
      return ProfileParameter::kRq;
  }
  return ProfileParameter::kRq;
}

void judge_points(const MeasurementInput& input, const ProfileResult& found, EvaluatedMeasurement& made) {
  made.points = static_cast<std::int64_t>(found.points);
  made.valid_fraction = found.valid_fraction;
  if (found.values.front().reason == metrology::ProfileReason::kEvaluationLength) {
    made.reason = found.values.front().detail;  // no point was looked at
    return;
  }
  made.reason = too_few_valid(found.valid_fraction, input.planned);
  if (!made.reason.empty()) made.reason_code = evaluation_code::kTooFewValid;
}

ordered_json details_json(const MeasurementInput& input, const NoiseFloor& floor, const Profile& profile,
                          const ProfileResult& found) {
  ordered_json json = texture_conditions(input, floor);
  json["label_suffix"] = found.label_suffix;
  json["default_settings"] = found.default_settings ? ordered_json(*found.default_settings) : ordered_json(nullptr);
  json["evaluation_length_um"] = found.evaluation_length_um;
  json["section_length_um"] = found.section_length_um;
  json["sections"] = found.sections;
  json["longest_hole_um"] = found.longest_hole_um;
  json["hill_discrimination_um"] = number_or_null(found.height_discrimination_hill_um);
  json["dale_discrimination_um"] = number_or_null(found.height_discrimination_dale_um);
  json["length_discrimination_um"] = number_or_null(found.length_discrimination_um);
  json["pitch_um"] = profile.pitch_um;
  json["points"] = profile.z_um.size();
  return json;
}

}  // namespace

EvaluatedMeasurement measure_profile(const MeasurementInput& input) {
  EvaluatedMeasurement made;
  made.main_value = profile_value_key(input.planned.parameters.front());
  const HeightField& field = input.surface.field;
  const ProfileLine line = line_of(input.planned);
  const std::optional<Profile> profile = extracted(field, line, made);
  if (!profile) return made;
  std::vector<ProfileParameter> parameters;
  for (const std::string& name : input.planned.parameters) {
    parameters.push_back(metrology::profile_parameter_from_name(name).value());
  }
  metrology::ProfileSettings settings;
  settings.nesting_um = input.planned.nesting_um;
  settings.sections = input.planned.sections;
  const metrology::Region band = band_region(field, line);
  const NoiseFloor floor = noise_floor(input, band);
  settings.noise_floor_um = floor.sq_um;
  std::vector<ProfileParameter> with_squares = parameters;
  std::transform(parameters.begin(), parameters.end(), std::back_inserter(with_squares), root_mean_square_of);
  const ProfileResult found = metrology::evaluate_profile(*profile, with_squares, settings);
  judge_points(input, found, made);
  const auto draws = drawn(field, line, band, parameters, settings, input.pool);
  bool told_below_noise = false;
  made.not_evaluated = texture_not_evaluated(input);
  if (std::find(made.not_evaluated.begin(), made.not_evaluated.end(), "slice_z") == made.not_evaluated.end()) {
    made.not_evaluated.emplace_back("slice_z");
  }
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const std::string key = profile_value_key(input.planned.parameters[i]);
    ValueInput value;
    value.value = found.values[i].value;
    value.reason = found.values[i].detail;
    const std::optional<double> square_um = found.values[parameters.size() + i].value;
    value.below_noise = is_below_noise(square_um, floor);
    if (value.below_noise && !told_below_noise) {
      warn_below_noise(*square_um, floor, made);
      told_below_noise = true;
    }
    if (value.value && draws && draws->values[i].u) {
      metrology::BudgetEntry entry;
      entry.source = "noise";
      entry.type = metrology::UncertaintyType::kA;
      entry.u = *draws->values[i].u;
      entry.dof = draws->values[i].draws - 1;
      value.budget.entries.push_back(entry);
      value.u_method = "monte_carlo";
    }
    add_instrument(input, key, value);
    note_not_evaluated(value.budget, made);
    EvaluatedValue judged = judged_value(value, key, input.planned, input.plan.decision);
    if (found.values[i].tie) judged.warnings.push_back({"tie", "two candidates are equal; the first was taken"});
    made.values[key] = std::move(judged);
  }
  ordered_json details = details_json(input, floor, *profile, found);
  details["monte_carlo"] = draws ? ordered_json{{"draws", draws->draws}, {"seed", draws->seed}} : ordered_json(nullptr);
  made.details = details.dump();
  made.cross_section = profile_section(input.planned);
  return made;
}

}  // namespace fvd
