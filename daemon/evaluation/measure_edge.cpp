/// Cutting edges: rounding and chipping.

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <utility>

#include <nlohmann/json.hpp>

#include "core/metrology/edge/cutting_edge.hpp"
#include "core/metrology/operations/region.hpp"
#include "daemon/evaluation/instrument_budget.hpp"
#include "daemon/evaluation/measure_kinds.hpp"
#include "daemon/evaluation/measured_section.hpp"
#include "daemon/evaluation/noise_floor.hpp"
#include "daemon/evaluation/plan_regions.hpp"
#include "daemon/evaluation/section_fit.hpp"
#include "daemon/evaluation/value_uncertainty.hpp"

namespace fvd {

namespace {

using metrology::CuttingEdge;
using metrology::EdgeQuantity;
using metrology::EdgeReason;
using metrology::EdgeValue;
using nlohmann::ordered_json;

constexpr std::size_t kMostSectionsTold = 1000;  ///< details that are longer than 1 MiB do not read back

metrology::RakeSide rake_side(const std::string& name) {
  if (name == "right") return metrology::RakeSide::kRight;
  if (name == "top") return metrology::RakeSide::kTop;
  if (name == "bottom") return metrology::RakeSide::kBottom;
  return metrology::RakeSide::kLeft;
}

metrology::EdgeOptions options_of(const PlannedMeasurement& planned) {
  metrology::EdgeOptions options;
  options.rake_side = rake_side(planned.rake_side);
  if (planned.method == "tolerance") {
    options.method = metrology::EdgeMethod::kTolerance;
  } else if (planned.model == "circle") {
    options.method = metrology::EdgeMethod::kCircle;
  }
  options.sections_every_um = planned.sections_every_um;
  options.flank_from_um = planned.flank_um.at(0);
  options.flank_to_um = planned.flank_um.at(1);
  options.tolerance_um = planned.tolerance_um;
  if (planned.chipping) {
    options.chipping.min_depth_um = planned.chipping->min_depth_um;
    options.chipping.min_width_um = planned.chipping->min_width_um;
  }
  return options;
}

ValueInput value_input(const EdgeValue& value, int sections) {
  ValueInput input;
  input.value = value.median;
  if (!value.median) input.reason = metrology::edge_reason_text(value.reason);
  if (!value.median || !value.u) return input;
  metrology::BudgetEntry entry;
  entry.source = "sections";
  entry.type = metrology::UncertaintyType::kA;
  entry.u = *value.u;
  // Where the points' noise is the larger part, the number of sections does not matter.
  if (!value.u_noise || *value.u_noise < *value.u) entry.dof = std::max(1, sections - 1);
  input.budget.entries.push_back(entry);
  input.u_method = "jacobian";
  return input;
}

/// Where the truth may be anything from 0 to a bound, only the bound against the limits tells something.
void judge_at_most(double bound, EvaluatedValue& value) {
  if (!value.limits) return;
  const Limits& limits = *value.limits;
  const bool none_conforms = limits.lower && bound < *limits.lower;
  const bool all_conform = limits.lower.value_or(0.0) <= 0.0 && (!limits.upper || bound <= *limits.upper);
  value.probability.reset();
  value.verdict = none_conforms ? Verdict::kFail : (all_conform ? Verdict::kPass : Verdict::kUncertain);
}

/// Where the truth may be larger than what was read, an upper limit is not shown to be kept.
void judge_at_least(EvaluatedValue& value) {
  if (!value.limits || !value.limits->upper || value.verdict != Verdict::kPass) return;
  value.verdict = Verdict::kUncertain;
  value.probability.reset();
}

void add_value(const MeasurementInput& input, const std::string& key, ValueInput value, EvaluatedMeasurement& made) {
  // The sharpest place is a biased one, which no scatter tells.
  if (key != metrology::edge_quantity_key(EdgeQuantity::kRMin)) add_instrument(input, key, value);
  note_not_evaluated(value.budget, made);
  made.values[key] = judged_value(value, key, input.planned, input.plan.decision);
}

void add_figure(const MeasurementInput& input, const std::string& key, std::optional<double> figure,
                const std::string& reason, EvaluatedMeasurement& made) {
  ValueInput value;
  value.value = figure;
  if (!figure) value.reason = reason;
  add_value(input, key, value, made);
}

/// A count or a share, which is what it is.
void add_share(const MeasurementInput& input, const std::string& key, std::optional<double> figure,
               const std::string& reason, EvaluatedMeasurement& made) {
  ValueInput value;
  value.value = figure;
  value.exact = true;
  if (!figure) value.reason = reason;
  add_value(input, key, value, made);
}

ordered_json section_json(const metrology::EdgeSection& section) {
  ordered_json json{{"along_um", section.along_um}, {"x_um", section.x_um}, {"y_um", section.y_um}};
  if (section.state != EdgeReason::kNone) {
    json["unmeasured"] = metrology::edge_reason_text(section.state);
    return json;
  }
  for (std::size_t i = 0; i < metrology::kEdgeQuantityCount; ++i) {
    if (section.values[i])
      json[std::string(metrology::edge_quantity_key(static_cast<EdgeQuantity>(i)))] = *section.values[i];
  }
  return json;
}

ordered_json notch_json(const metrology::Notch& notch) {
  return {{"along_um", notch.along_um}, {"x_um", notch.x_um},         {"y_um", notch.y_um},
          {"depth_um", notch.depth_um}, {"width_um", notch.width_um}, {"area_um2", notch.area_um2},
          {"open", notch.open},         {"resolved", notch.resolved}};
}

ordered_json spreads_json(const CuttingEdge& edge) {
  ordered_json json = ordered_json::object();
  for (std::size_t i = 0; i < metrology::kEdgeQuantityCount; ++i) {
    const EdgeValue& value = edge.values[i];
    if (!value.median) continue;
    ordered_json one = ordered_json::object();
    if (value.standard_error) one["standard_error"] = *value.standard_error;
    if (value.p10) one["p10"] = *value.p10;
    if (value.p90) one["p90"] = *value.p90;
    one["at_most"] = value.at_most;
    json[std::string(metrology::edge_quantity_key(static_cast<EdgeQuantity>(i)))] = std::move(one);
  }
  return json;
}

/// The edge line for pictures: places at even distances, of several the one where most is missing; null = not measured.
ordered_json line_json(const std::vector<metrology::EdgeLinePoint>& line) {
  constexpr std::size_t kMostPlaces = 300;
  constexpr double kPerMicrometre = 1e3;
  const std::size_t block = (line.size() + kMostPlaces - 1) / kMostPlaces;
  ordered_json deviations = ordered_json::array();
  for (std::size_t begin = 0; begin < line.size(); begin += block) {
    std::optional<double> most;
    for (std::size_t i = begin; i < std::min(begin + block, line.size()); ++i) {
      if (line[i].deviation_um) most = std::max(most.value_or(*line[i].deviation_um), *line[i].deviation_um);
    }
    deviations.push_back(most ? ordered_json(std::round(*most * kPerMicrometre) / kPerMicrometre) : ordered_json());
  }
  const double every_um = line.size() < 2 ? 0.0
                                          : (line.back().along_um - line.front().along_um) /
                                                static_cast<double>(line.size() - 1) * static_cast<double>(block);
  return {{"from_um", line.empty() ? 0.0 : line.front().along_um},
          {"every_um", every_um},
          {"missing_um", std::move(deviations)}};
}

ordered_json details_json(const CuttingEdge& edge) {
  ordered_json json{{"direction_deg", edge.direction_deg},
                    {"window_um", edge.window_um},
                    {"radius_smallest_resolvable_um", edge.radius_smallest_resolvable_um},
                    {"sections_measured", edge.sections_measured}};
  if (edge.method == metrology::EdgeMethod::kTolerance) json["tolerance_um"] = edge.tolerance_um;
  json["spread"] = spreads_json(edge);
  json["sections"] = ordered_json::array();
  for (const auto& section : edge.sections) {
    if (json["sections"].size() == kMostSectionsTold) break;
    json["sections"].push_back(section_json(section));
  }
  json["sections_not_told"] = edge.sections.size() - json["sections"].size();
  const metrology::ChippingResult& chipping = edge.chipping;
  ordered_json chips{{"depth_limit_um", chipping.depth_limit_um},
                     {"robust_sd_um", chipping.robust_sd_um},
                     {"length_um", chipping.length_um},
                     {"unmeasured_um", chipping.unmeasured_um},
                     {"notches", ordered_json::array()}};
  for (const metrology::Notch& notch : chipping.notches) chips["notches"].push_back(notch_json(notch));
  if (!chipping.line.empty()) chips["line"] = line_json(chipping.line);
  json["chipping"] = std::move(chips);
  return json;
}

void add_chipping(const MeasurementInput& input, const CuttingEdge& edge, EvaluatedMeasurement& made) {
  const metrology::ChippingResult& chipping = edge.chipping;
  const bool there = chipping.reason == EdgeReason::kNone;
  const std::string reason(metrology::edge_reason_text(chipping.reason));
  add_figure(input, "edge_Pt_um", chipping.edge_pt_um, reason, made);
  add_figure(input, "edge_Rz_um", chipping.edge_rz_um, reason, made);
  const auto when_there = [there](double value) { return there ? std::optional(value) : std::nullopt; };
  // The edge line's scatter is what a notch's depth is uncertain by.
  ValueInput deepest;
  deepest.value = when_there(chipping.deepest_um());
  if (!there) deepest.reason = reason;
  if (there) {
    metrology::BudgetEntry entry;
    entry.source = "edge_line";
    entry.type = metrology::UncertaintyType::kA;
    entry.u = chipping.robust_sd_um;
    // A notch below the limit that this line allows stays unseen.
    const bool coarse = chipping.depth_limit_um > input.planned.chipping->min_depth_um;
    if (coarse && chipping.deepest_um() < chipping.depth_limit_um) entry.u = chipping.depth_limit_um / std::sqrt(3.0);
    deepest.budget.entries.push_back(entry);
    deepest.u_method = "spread";
  }
  add_value(input, "chipping_max_um", deepest, made);
  add_share(input, "notches", when_there(static_cast<double>(chipping.notches.size())), reason, made);
  add_share(input, "unmeasured_fraction", chipping.unmeasured_fraction(), reason, made);
  if (there && chipping.depth_limit_um > input.planned.chipping->min_depth_um) {
    std::ostringstream text;
    text.precision(3);
    text << "the edge line scatters, so that notches are found from " << chipping.depth_limit_um
         << " um on, not from the recipe's " << input.planned.chipping->min_depth_um << " um";
    made.warnings.push_back({"notch_limit_raised", text.str()});
  }
  const auto any_notch = [&chipping](bool (*is)(const metrology::Notch&)) {
    return std::any_of(chipping.notches.begin(), chipping.notches.end(), is);
  };
  const auto tell = [&made](const char* code, const char* text) {
    made.warnings.push_back({code, text});
    judge_at_least(made.values.at("chipping_max_um"));
  };
  if (any_notch([](const metrology::Notch& notch) { return !notch.resolved; })) {
    tell("notch_not_resolved", "a notch is narrower than two focus windows: it is deeper than it reads");
  }
  if (any_notch([](const metrology::Notch& notch) { return notch.open; })) {
    tell("notch_open", "a notch reaches into a part that is not measured: it is at least as deep as it reads");
  }
}

/// Why nothing can be measured with this recipe on this surface; empty where something can.
std::string refused(const MeasurementInput& input, const metrology::Region& region, EvaluatedMeasurement& made) {
  const metrology::HeightField& field = input.surface.field;
  if (!region.empty() && metrology::count_points(region) == 0) {
    made.reason_code = evaluation_code::kRegionOutside;
    return "the region " + input.planned.region + " has no point in the field of view";
  }
  if (input.planned.sections_every_um >= std::min(field.pitch_x_um, field.pitch_y_um)) return {};
  std::ostringstream text;
  text << "sections_every_um of " << input.planned.sections_every_um << " um is below the distance of the points, "
       << std::min(field.pitch_x_um, field.pitch_y_um) << " um";
  return text.str();
}

}  // namespace

EvaluatedMeasurement measure_edge(const MeasurementInput& input) {
  EvaluatedMeasurement made;
  made.method = input.planned.method == "tolerance" ? "tolerance" : input.planned.model;
  made.main_value = "radius_um";
  made.region = input.planned.region;
  const metrology::HeightField& field = input.surface.field;
  const metrology::Region region = region_points(input.plan, input.planned.region, field);
  made.reason = refused(input, region, made);
  if (!made.reason.empty()) return made;
  const CuttingEdge edge = metrology::measure_cutting_edge(field, region, options_of(input.planned));
  if (edge.reason != EdgeReason::kNone) {
    made.reason = metrology::edge_reason_text(edge.reason);
    return made;
  }
  made.points = edge.points;
  made.valid_fraction = edge.valid_fraction;
  made.reason = too_few_valid(edge.valid_fraction, input.planned);
  if (!made.reason.empty()) made.reason_code = evaluation_code::kTooFewValid;
  for (std::size_t i = 0; i < metrology::kEdgeQuantityCount; ++i) {
    const std::string key(metrology::edge_quantity_key(static_cast<EdgeQuantity>(i)));
    ValueInput found = value_input(edge.values[i], edge.sections_measured);
    // Noise makes the sharpest place sharper, by more than its scatter.
    if (static_cast<EdgeQuantity>(i) == EdgeQuantity::kRMin) found.budget.entries.clear();
    add_value(input, key, found, made);
    if (!edge.values[i].at_most) continue;
    judge_at_most(edge.radius_smallest_resolvable_um, made.values.at(key));
    made.warnings.push_back({"at_most", key + " is below what the focus window resolves: read it as at most " +
                                            std::to_string(edge.radius_smallest_resolvable_um) + " um"});
  }
  if (input.planned.chipping) {
    add_chipping(input, edge, made);
    if (made.reason.empty() && edge.chipping.unmeasured_fraction() > input.planned.chipping->max_unmeasured_fraction) {
      std::ostringstream text;
      text.precision(3);
      text << 100.0 * edge.chipping.unmeasured_fraction() << " % of the edge could not be measured; the recipe allows "
           << 100.0 * input.planned.chipping->max_unmeasured_fraction << " %";
      made.reason = text.str();
    }
  }
  if (!field.has_sigma()) made.not_evaluated.emplace_back("noise");
  made.not_evaluated.emplace_back("slice_z");
  if (!edge.chipping.notches.empty()) {
    made.not_evaluated.emplace_back("window_transfer");
    made.warnings.push_back({"notch_depth_through_window",
                             "the focus window averages notches, which read too shallow by a part that no U contains: "
                             "keep a limit for their depth well above what is read"});
  }
  made.details = details_json(edge).dump();
  made.cross_section = edge_section(edge, input.planned);
  if (made.cross_section) add_edge_fit(input, edge, *made.cross_section);
  return made;
}

}  // namespace fvd
