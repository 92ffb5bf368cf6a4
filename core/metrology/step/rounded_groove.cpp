/// Rounded bottom: ISO 5436-1 type A2.

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Dense>

#include "core/metrology/step/groove_layout.hpp"
#include "core/metrology/step/groove_step.hpp"
#include "core/metrology/step/trace_mean.hpp"

namespace fvd::metrology {

namespace {

constexpr std::size_t kLeastTraces = 5;
constexpr int kRounds = 50;
constexpr double kSettled_um = 1e-12;

/// Points of a strip in terms of a middle, which keeps the fits well conditioned.
struct Points {
  std::vector<int> columns;
  std::vector<int> rows;
  Eigen::VectorXd x;
  Eigen::VectorXd z;
};

/// z at a place as a linear function of the points' heights.
struct Prediction {
  double z_um = 0.0;
  Eigen::VectorXd by_height;
};

Points points_of(const HeightField& field, const PointGroups& groups, int group, double middle_um) {
  Points points;
  std::vector<double> x;
  std::vector<double> z;
  for (int row = 0; row < groups.group.height(); ++row) {
    for (int column = 0; column < groups.group.width(); ++column) {
      const int at = groups.left + column;
      if (groups.group.at(column, row) != group || field.is_hole(at, groups.top + row)) continue;
      points.columns.push_back(at);
      points.rows.push_back(groups.top + row);
      x.push_back(field.x_um(at) - middle_um);
      z.push_back(field.z_um.at(at, groups.top + row));
    }
  }
  points.x = Eigen::Map<Eigen::VectorXd>(x.data(), static_cast<Eigen::Index>(x.size()));
  points.z = Eigen::Map<Eigen::VectorXd>(z.data(), static_cast<Eigen::Index>(z.size()));
  return points;
}

struct Line {
  double offset_um = 0.0;
  double slope = 0.0;
  Eigen::MatrixXd by_height;  // 2 x points: of offset and slope
};

Line fit_line(const Points& points) {
  Eigen::MatrixXd design(points.x.size(), 2);
  design.col(0).setOnes();
  design.col(1) = points.x;
  Line line;
  line.by_height = (design.transpose() * design).ldlt().solve(design.transpose());
  const Eigen::Vector2d found = line.by_height * points.z;
  line.offset_um = found(0);
  line.slope = found(1);
  return line;
}

/// z = parameters over x, and its derivatives to them.
struct Bottom {
  BottomForm form = BottomForm::kParabola;
  Eigen::Vector3d p =
      Eigen::Vector3d::Zero();  // parabola: z = p0 + p1 x + p2 x^2; circle: x0, z0, R (negative: from above)

  [[nodiscard]] double z_um(double x) const {
    if (form == BottomForm::kParabola) return p(0) + x * (p(1) + x * p(2));
    const double half = x - p(0);
    return p(1) - std::copysign(std::sqrt(std::max(p(2) * p(2) - half * half, 0.0)), p(2));
  }
  [[nodiscard]] Eigen::RowVector3d derivatives(double x) const {
    if (form == BottomForm::kParabola) return {1.0, x, x * x};
    const double half = x - p(0);
    const double root = std::copysign(std::sqrt(std::max(p(2) * p(2) - half * half, 1e-12)), p(2));
    return {-half / root, 1.0, -p(2) / root};
  }
  [[nodiscard]] double radius_um() const {
    return form == BottomForm::kParabola ? 1.0 / (2.0 * std::abs(p(2))) : std::abs(p(2));
  }
  /// Where its slope is that of the line.
  [[nodiscard]] double place_of_slope(double slope) const {
    if (form == BottomForm::kParabola) return (slope - p(1)) / (2.0 * p(2));
    return p(0) + p(2) * slope / std::sqrt(1.0 + slope * slope);
  }
};

Bottom fit_parabola(const Points& points) {
  Eigen::MatrixXd design(points.x.size(), 3);
  design.col(0).setOnes();
  design.col(1) = points.x;
  design.col(2) = points.x.cwiseProduct(points.x);
  return {BottomForm::kParabola, design.colPivHouseholderQr().solve(points.z)};
}

/// Gauss and Newton from the parabola's circle of curvature, along z; nothing where it does not settle.
std::optional<Bottom> fit_circle(const Points& points, const Bottom& parabola) {
  Bottom circle;
  circle.form = BottomForm::kCircle;
  const double vertex = -parabola.p(1) / (2.0 * parabola.p(2));
  const double radius = 1.0 / (2.0 * parabola.p(2));
  circle.p = {vertex, parabola.z_um(vertex) + radius, radius};
  for (int round = 0; round < kRounds; ++round) {
    Eigen::MatrixXd jacobian(points.x.size(), 3);
    Eigen::VectorXd residual(points.x.size());
    for (Eigen::Index i = 0; i < points.x.size(); ++i) {
      jacobian.row(i) = circle.derivatives(points.x(i));
      residual(i) = points.z(i) - circle.z_um(points.x(i));
    }
    const Eigen::Vector3d change = jacobian.colPivHouseholderQr().solve(residual);
    if (!change.allFinite()) return std::nullopt;
    circle.p += change;
    if (change.cwiseAbs().maxCoeff() < kSettled_um * std::abs(circle.p(2))) return circle;
  }
  return std::nullopt;
}

Prediction predicted(const Bottom& bottom, const Points& points, double x) {
  Eigen::MatrixXd jacobian(points.x.size(), 3);
  for (Eigen::Index i = 0; i < points.x.size(); ++i) jacobian.row(i) = bottom.derivatives(points.x(i));
  const Eigen::Vector3d row = (jacobian.transpose() * jacobian).ldlt().solve(bottom.derivatives(x).transpose());
  return {bottom.z_um(x), jacobian * row};
}

struct RoundedTrace {
  MeasuredTrace measured;
  double radius_um = 0.0;
};

StepRefusal not_rounded(const std::string& why) {
  return {StepRefusalCode::kNotRounded, "the bottom has no vertex within the middle third: " + why, std::nullopt};
}

StepOutcome<RoundedTrace> measured(const HeightField& field, const GrooveLayout& layout, const RowRange& strip,
                                   BottomForm form, double sign) {
  const PointGroups groups = groove_groups(field, layout, strip);
  const double middle_um = layout.edges.centre_um();
  const Points land = points_of(field, groups, 1, middle_um);
  const Points bottom_points = points_of(field, groups, 2, middle_um);
  if (bottom_points.x.size() < 4 || land.x.size() < 3) return not_rounded("a trace has too few points");
  const Line line = fit_line(land);
  Bottom bottom = fit_parabola(bottom_points);
  // A groove's bottom opens upwards, a ridge's downwards.
  if (!(sign * bottom.p(2) > 0.0)) return not_rounded("it is flat or bends the other way");
  if (form == BottomForm::kCircle) {
    const auto circle = fit_circle(bottom_points, bottom);
    if (!circle) return not_rounded("no circle fits it");
    bottom = *circle;
  }
  const double vertex = bottom.place_of_slope(line.slope);
  if (!(std::abs(vertex) <= layout.edges.width_um() / 6.0)) return not_rounded("a trace's vertex lies beyond it");
  const Prediction deepest = predicted(bottom, bottom_points, vertex);
  const double root = std::sqrt(1.0 + line.slope * line.slope);
  RoundedTrace made;
  made.radius_um = bottom.radius_um();
  StepValue& value = made.measured.value;
  value.vertical_um = sign * (line.offset_um + line.slope * vertex - deepest.z_um);
  value.height_um = value.vertical_um / root;
  value.slope_x = line.slope;
  value.points = static_cast<int>(land.x.size() + bottom_points.x.size());
  WeightMap& map = value.weights;
  map.left = groups.left;
  map.top = groups.top;
  map.weights = Plane<double>(groups.group.width(), groups.group.height(), 0.0);
  const double per_slope = -value.vertical_um * line.slope / (root * root * root);
  for (Eigen::Index i = 0; i < land.x.size(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    const double by_line = line.by_height(0, i) + vertex * line.by_height(1, i);
    map.weights.at(land.columns[k] - map.left, land.rows[k] - map.top) =
        sign * by_line / root + per_slope * line.by_height(1, i);
  }
  for (Eigen::Index i = 0; i < bottom_points.x.size(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    map.weights.at(bottom_points.columns[k] - map.left, bottom_points.rows[k] - map.top) =
        -sign * deepest.by_height(i) / root;
  }
  made.measured.trace = {strip.first * field.pitch_y_um, (strip.last + 1) * field.pitch_y_um, value.height_um,
                         line.slope, value.points};
  return made;
}

StepOutcome<RoundedGroove> along_x(const HeightField& field, const GrooveSettings& settings, BottomForm form) {
  auto outcome = lay_out_groove(field, settings);
  if (auto* refusal = std::get_if<StepRefusal>(&outcome)) return *refusal;
  const GrooveLayout& layout = std::get<GrooveLayout>(outcome);
  RoundedGroove groove;
  groove.edges = layout.edges;
  groove.edges_given = layout.edges_given;
  groove.form = form;
  groove.regions = groove_counts(field, layout, layout.band);
  if (auto refusal = too_few_valid(groove.regions, settings.min_valid_fraction)) return *refusal;
  const double land = 0.5 * (groove.regions[0].mean_z_um + groove.regions[1].mean_z_um);
  const double sign = land < groove.regions[2].mean_z_um ? -1.0 : 1.0;
  groove.sign = sign < 0.0 ? GrooveSign::kRidge : GrooveSign::kGroove;
  std::vector<MeasuredTrace> traces;
  for (const RowRange& strip : layout.strips) {
    if (too_few_valid(groove_counts(field, layout, strip), settings.min_valid_fraction)) continue;
    auto trace = measured(field, layout, strip, form, sign);
    if (auto* refusal = std::get_if<StepRefusal>(&trace)) return *refusal;
    groove.radius_um += std::get<RoundedTrace>(trace).radius_um;
    traces.push_back(std::move(std::get<RoundedTrace>(trace).measured));
  }
  if (traces.size() < kLeastTraces) {
    return StepRefusal{StepRefusalCode::kTooFewTraces,
                       "only " + std::to_string(traces.size()) + " traces have enough valid points",
                       static_cast<double>(traces.size())};
  }
  groove.radius_um /= static_cast<double>(traces.size());
  groove.traces = list_of(traces, static_cast<int>(layout.strips.size() - traces.size()));
  groove.mean = mean_of(field, traces);
  return groove;
}

}  // namespace

StepOutcome<RoundedGroove> iso5436_a2(const HeightField& field, const GrooveSettings& settings, BottomForm form) {
  if (settings.across == Across::kX) return along_x(field, settings, form);
  auto outcome = along_x(transposed(field), settings, form);
  if (auto* groove = std::get_if<RoundedGroove>(&outcome)) turn_back(groove->mean);
  return outcome;
}

}  // namespace fvd::metrology
