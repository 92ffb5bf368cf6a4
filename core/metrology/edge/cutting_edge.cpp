#include "core/metrology/edge/cutting_edge.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <vector>

#include "core/metrology/edge/chipping.hpp"
#include "core/metrology/edge/edge_curve.hpp"
#include "core/metrology/edge/edge_planes.hpp"
#include "core/metrology/edge/edge_statistics.hpp"
#include "core/metrology/edge/flank_lines.hpp"
#include "core/metrology/edge/section_data.hpp"
#include "core/metrology/edge/section_evaluation.hpp"
#include "core/metrology/edge/section_values.hpp"
#include "core/metrology/edge/window_profile.hpp"

namespace fvd::metrology {
namespace {

using edge::EdgeCurve;
using edge::EvaluatedSection;
using edge::is_length;
using edge::SectionData;

constexpr int kCurveRounds = 2;

// Lays the curve through the places where the flanks' lines meet.
void follow_flanks(const HeightField& field, const Region& region, const EdgeOptions& options, EdgeCurve& curve) {
  for (int round = 0; round < kCurveRounds && curve.is_there(); ++round) {
    std::vector<edge::SpacePoint> apexes;
    for (const SectionData& section : cut_sections(field, region, curve, options)) {
      if (section.state != EdgeReason::kNone) continue;
      const auto lines = find_flank_lines(section, options);
      if (lines) apexes.push_back(section.frame.at(lines->apex_s_um, lines->apex_h_um));
    }
    curve.fit(apexes, options.bend_degree, field, region);
  }
}

double direction_deg(const edge::EdgeFrame& frame) {
  const double degrees = std::atan2(frame.e_y, frame.e_x) * 180.0 / std::numbers::pi;
  const double positive = degrees < 0.0 ? degrees + 180.0 : degrees;
  return positive >= 180.0 ? positive - 180.0 : positive;
}

bool needs_resolution(EdgeQuantity quantity) {
  return quantity == EdgeQuantity::kSGamma || quantity == EdgeQuantity::kSAlpha || quantity == EdgeQuantity::kK ||
         quantity == EdgeQuantity::kDeltaR || quantity == EdgeQuantity::kPhi || quantity == EdgeQuantity::kRMin;
}

void not_below_nothing(std::optional<double>& value) {
  if (value) value = std::max(0.0, *value);
}

EdgeValue over_sections(EdgeQuantity quantity, const std::vector<EvaluatedSection>& sections, bool has_sigma,
                        const EdgeOptions& options, double window_um) {
  const auto q = static_cast<std::size_t>(quantity);
  std::vector<double> values;
  std::vector<double> noise;
  std::vector<double> along;
  for (const EvaluatedSection& section : sections) {
    const auto& figure = section.result.values[q];
    if (section.result.state != EdgeReason::kNone || !figure) continue;
    values.push_back(*figure);
    along.push_back(section.result.along_um);
    if (section.result.u[q]) noise.push_back(*section.result.u[q]);
  }
  if (values.empty()) {
    EdgeValue value;
    value.reason = edge::absent_by_method(quantity, options.method);
    if (value.reason == EdgeReason::kNone) value.reason = EdgeReason::kNoSection;
    value.u_reason = value.reason;
    return value;
  }
  EdgeValue value = edge::summarise(values, noise, edge::shared_noise(along, options.sections_every_um, window_um),
                                    is_length(quantity));
  if (!has_sigma) {
    value.u.reset();
    value.u_reason = EdgeReason::kNoSigma;
  }
  if (is_length(quantity)) {
    for (auto* figure : {&value.median, &value.p10, &value.p90}) not_below_nothing(*figure);
  }
  return value;
}

void summarise_all(const std::vector<EvaluatedSection>& sections, bool has_sigma, const EdgeOptions& options,
                   CuttingEdge& result) {
  for (std::size_t q = 0; q < kEdgeQuantityCount; ++q) {
    result.values[q] = over_sections(static_cast<EdgeQuantity>(q), sections, has_sigma, options, result.window_um);
  }
  EdgeValue& radius = result.values[static_cast<std::size_t>(EdgeQuantity::kRadius)];
  if (!radius.median || *radius.median >= result.radius_smallest_resolvable_um) return;
  radius.at_most = true;
  for (std::size_t q = 0; q < kEdgeQuantityCount; ++q) {
    if (!needs_resolution(static_cast<EdgeQuantity>(q)) || !result.values[q].median) continue;
    result.values[q] = EdgeValue{};
    result.values[q].reason = result.values[q].u_reason = EdgeReason::kBelowResolution;
  }
}

void keep_sections(std::vector<EvaluatedSection>& sections, CuttingEdge& result) {
  for (EvaluatedSection& section : sections) {
    for (std::size_t q = 0; q < kEdgeQuantityCount; ++q) {
      if (is_length(static_cast<EdgeQuantity>(q))) not_below_nothing(section.result.values[q]);
    }
    result.sections.push_back(section.result);
  }
}

}  // namespace

CuttingEdge measure_cutting_edge(const HeightField& field, const Region& region, const EdgeOptions& options) {
  assert(region.empty() || (region.width() == field.width() && region.height() == field.height()));
  assert(options.flank_from_um > 0.0 && options.flank_to_um > options.flank_from_um);
  assert(options.sections_every_um >= std::min(field.pitch_x_um, field.pitch_y_um));
  assert(options.bend_degree >= 1 && options.bend_degree <= 3);
  CuttingEdge result;
  result.method = options.method;
  if (options.method == EdgeMethod::kTolerance) result.tolerance_um = options.tolerance_um;
  const edge::FoundPlanes planes = edge::find_planes(field, region, options);
  result.reason = planes.reason;
  if (result.reason != EdgeReason::kNone) return result;
  EdgeCurve curve(planes.edge, field, region);
  follow_flanks(field, region, options, curve);
  if (!curve.is_there()) {
    result.reason = EdgeReason::kNoSection;
    return result;
  }
  const edge::EdgeFrame middle = curve.frame(curve.place_at_length(curve.whole_length_um() / 2.0));
  result.direction_deg = direction_deg(middle);
  result.window_um =
      edge::WindowProfile(field.kernel, field.pitch_x_um, field.pitch_y_um, middle.u_x, middle.u_y).width_um();
  result.radius_smallest_resolvable_um = result.window_um / 2.0;

  const std::vector<SectionData> data = cut_sections(field, region, curve, options);
  std::vector<EvaluatedSection> sections = edge::evaluate_sections(data, field, options);
  std::vector<edge::SpacePoint> apexes;
  long possible = 0;
  for (std::size_t i = 0; i < data.size(); ++i) {
    possible += data[i].possible;
    if (sections[i].result.state != EdgeReason::kNone) continue;
    ++result.sections_measured;
    result.points += static_cast<long>(data[i].points.size());
    apexes.push_back(data[i].frame.at(sections[i].apex_s_um, sections[i].apex_h_um));
  }
  if (possible > 0) result.valid_fraction = static_cast<double>(result.points) / static_cast<double>(possible);
  summarise_all(sections, field.has_sigma(), options, result);
  keep_sections(sections, result);
  if (apexes.empty()) {
    result.reason = EdgeReason::kNoSection;
    return result;
  }
  curve.fit(apexes, options.bend_degree, field, region);
  const double along_um =
      edge::WindowProfile(field.kernel, field.pitch_x_um, field.pitch_y_um, middle.e_x, middle.e_y).width_um();
  result.chipping = edge::measure_chipping(field, region, curve, along_um, options);
  return result;
}

}  // namespace fvd::metrology
