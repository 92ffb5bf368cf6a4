#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/metrology/step/bottom_curve.hpp"
#include "core/metrology/step/groove_layout.hpp"
#include "core/metrology/step/groove_step.hpp"
#include "core/metrology/step/step_parts.hpp"

namespace fvd::metrology {
namespace {

constexpr std::size_t kLeastTraces = 5;  // ISO 5436-1:2000, 7.1

struct BottomPoint {
  int column = 0;
  int row = 0;
  double along_um = 0.0;
  double across_um = 0.0;
  double z_um = 0.0;
};

std::vector<BottomPoint> bottom_points(const HeightField& field, const PointGroups& groups, Across across) {
  std::vector<BottomPoint> points;
  for (int y = 0; y < groups.group.height(); ++y) {
    for (int x = 0; x < groups.group.width(); ++x) {
      const int column = groups.left + x;
      const int row = groups.top + y;
      if (groups.group.at(x, y) != kBottom || field.is_hole(column, row)) continue;
      BottomPoint point{column, row, field.x_um(column), field.y_um(row), field.z_um.at(column, row)};
      if (across == Across::kY) std::swap(point.along_um, point.across_um);
      points.push_back(point);
    }
  }
  return points;
}

struct RoundedTrace {
  StepValue value;
  double slope = 0.0;  // along the trace
  double radius_um = 0.0;
};

/// One strip. The line is z = zs + a (x - xs) + b (y - ys), s the centre of A and B; b is 0 in a strip of one row. The
/// curve c(x) goes through z - b (y - ys) of the points of C. At the vertex v, c' = a, and so to first order v does not
/// move the depth d = (zs + a (v - xs) - c(v)) / sqrt(1 + a^2).
class RoundedStrip {
 public:
  RoundedStrip(const HeightField& field, const GrooveLayout& layout, const GrooveStrip& strip, double sign)
      : field_(field), layout_(layout), groups_(groove_groups(field, layout, strip)), sign_(sign) {
    line_ = JointLevels::fit(field, groups_, layout.axes_of(strip), {kShoulders});
  }

  [[nodiscard]] bool has_line() const { return line_.has_value(); }

  /// Absent where the bottom has no vertex within C.
  [[nodiscard]] std::optional<RoundedTrace> measure(BottomForm form) const {
    const bool along_x = layout_.across == Across::kX;
    // Ridges are turned over, so that the bottom is always below the line.
    const double a = sign_ * (along_x ? line_->slope_x() : line_->slope_y());
    const double b = along_x ? line_->slope_y() : line_->slope_x();
    const double xs = along_x ? line_->mean_x_um(kShoulders) : line_->mean_y_um(kShoulders);
    const double ys = along_x ? line_->mean_y_um(kShoulders) : line_->mean_x_um(kShoulders);
    const double zs = sign_ * line_->mean_z_um(kShoulders);
    const std::vector<BottomPoint> bottom = bottom_points(field_, groups_, layout_.across);
    std::vector<TracePoint> levelled;
    levelled.reserve(bottom.size());
    for (const BottomPoint& point : bottom) {
      levelled.push_back({point.along_um, sign_ * (point.z_um - b * (point.across_um - ys))});
    }
    const std::optional<BottomCurve> curve = BottomCurve::fit(levelled, form);
    if (!curve.has_value()) return std::nullopt;
    const double vertex = curve->vertex_um(a);
    const FromTo middle = groove_regions(layout_.edges)[2];
    const double below = zs + a * (vertex - xs) - curve->z_um(vertex);
    if (vertex < middle.from_um || vertex > middle.to_um || below <= 0.0) return std::nullopt;

    RoundedTrace trace;
    const double stretch = std::sqrt(1.0 + a * a);
    trace.slope = sign_ * a;
    trace.radius_um = curve->radius_um(vertex);
    trace.value.height_um = below / stretch;
    trace.value.vertical_um = below;
    trace.value.slope_x = line_->slope_x();
    trace.value.slope_y = line_->slope_y();
    trace.value.points = line_->points(kShoulders) + line_->points(kBottom);

    std::vector<double> influence;
    influence.reserve(bottom.size());
    double of_tilt = 0.0;  // change of c(v) with b
    for (const BottomPoint& point : bottom) {
      influence.push_back(curve->influence(vertex, point.along_um));
      of_tilt -= sign_ * influence.back() * (point.across_um - ys);
    }
    const double per_a = sign_ * ((vertex - xs) / stretch - below * a / (stretch * stretch * stretch));
    const double per_b = -of_tilt / stretch;
    trace.value.weights = line_->weights(field_, groups_, kShoulders, kBottom, 0.0,
                                         along_x ? std::array{per_a, per_b} : std::array{per_b, per_a});
    add_mean_of_line(sign_ / stretch / line_->points(kShoulders), trace.value.weights);
    for (std::size_t i = 0; i < bottom.size(); ++i) {
      trace.value.weights.weights.at(bottom[i].column - groups_.left, bottom[i].row - groups_.top) -=
          sign_ * influence[i] / stretch;
    }
    return trace;
  }

 private:
  void add_mean_of_line(double weight, WeightMap& map) const {
    for (int y = 0; y < groups_.group.height(); ++y) {
      for (int x = 0; x < groups_.group.width(); ++x) {
        if (groups_.group.at(x, y) != kShoulders || field_.is_hole(groups_.left + x, groups_.top + y)) continue;
        map.weights.at(x, y) += weight;
      }
    }
  }

  const HeightField& field_;
  const GrooveLayout& layout_;
  PointGroups groups_;
  double sign_;
  std::optional<JointLevels> line_;
};

/// Traces and their mean; a refusal where a bottom is not rounded.
std::optional<StepRefusal> measure_traces(const HeightField& field, const GrooveLayout& layout,
                                          double min_valid_fraction, double sign, RoundedGroove& groove) {
  std::vector<RoundedTrace> found;
  for (const GrooveStrip& strip : layout.strips) {
    const std::array<StepRegion, 3> regions = count_regions(field, layout, strip);
    const bool has_points = !refused_for_holes(regions, min_valid_fraction).has_value();
    std::optional<RoundedStrip> rounded;
    if (has_points) rounded.emplace(field, layout, strip, sign);
    if (!rounded.has_value() || !rounded->has_line()) {
      ++groove.traces.left_out;
      continue;
    }
    std::optional<RoundedTrace> trace = rounded->measure(groove.form);
    if (!trace.has_value()) {
      return StepRefusal{StepRefusalCode::kNotRounded,
                         "the trace from " + figure_text(strip.from_um) + " to " + figure_text(strip.to_um) +
                             " um has no vertex within the middle third of the groove",
                         std::nullopt};
    }
    groove.traces.each.push_back(
        {strip.from_um, strip.to_um, trace->value.height_um, trace->slope, trace->value.points});
    found.push_back(std::move(*trace));
  }
  if (found.size() < kLeastTraces) return std::nullopt;
  summarize(groove.traces);
  groove.mean.height_um = groove.traces.mean_um;
  groove.mean.weights = empty_weights(field, layout);
  const double share = 1.0 / static_cast<double>(found.size());
  for (const RoundedTrace& trace : found) {
    groove.radius_um += share * trace.radius_um;
    groove.mean.vertical_um += share * trace.value.vertical_um;
    groove.mean.slope_x += share * trace.value.slope_x;
    groove.mean.slope_y += share * trace.value.slope_y;
    groove.mean.points += trace.value.points;
    add_scaled(trace.value.weights, share, groove.mean.weights);
  }
  groove.mean.noise = linear_noise(field, groove.mean.weights);
  return std::nullopt;
}

}  // namespace

StepOutcome<RoundedGroove> iso5436_a2(const HeightField& field, const GrooveSettings& settings, BottomForm form) {
  StepOutcome<GrooveLayout> laid_out = lay_out_groove(field, settings);
  if (auto* refusal = std::get_if<StepRefusal>(&laid_out)) return std::move(*refusal);
  const GrooveLayout& layout = std::get<GrooveLayout>(laid_out);

  RoundedGroove groove;
  groove.form = form;
  groove.edges = layout.edges;
  groove.edges_given = layout.edges_given;
  groove.regions = count_regions(field, layout, layout.band);
  if (auto refusal = refused_for_holes(groove.regions, settings.min_valid_fraction)) return std::move(*refusal);
  const auto plane =
      JointLevels::fit(field, groove_groups(field, layout, layout.band), layout.axes_of(layout.band), {kShoulders});
  if (!plane.has_value()) {
    return StepRefusal{StepRefusalCode::kNoSlope, "the regions A and B do not define a plane", std::nullopt};
  }
  const double sign = plane->difference_um(kShoulders, kBottom) < 0.0 ? -1.0 : 1.0;
  groove.sign = sign < 0.0 ? GrooveSign::kRidge : GrooveSign::kGroove;
  if (auto refusal = measure_traces(field, layout, settings.min_valid_fraction, sign, groove)) {
    return std::move(*refusal);
  }
  if (groove.traces.each.size() < kLeastTraces) {
    return StepRefusal{StepRefusalCode::kTooFewTraces,
                       std::to_string(groove.traces.each.size()) + " of " + std::to_string(layout.strips.size()) +
                           " traces have enough points, and five are asked for",
                       static_cast<double>(groove.traces.each.size())};
  }
  return groove;
}

}  // namespace fvd::metrology
