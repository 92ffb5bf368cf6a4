#include "core/metrology/edge/section_fit.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>
#include <vector>

#include <Eigen/Cholesky>
#include <unsupported/Eigen/NonLinearOptimization>

#include "core/metrology/edge/whitening.hpp"

namespace fvd::metrology::edge {
namespace {

constexpr int kRobustRounds = 4;
constexpr double kHuberCut = 1.345;
constexpr double kPriorLogK = 1.5;
constexpr double kPriorLogWeight = 0.75;
constexpr double kLeastNoiseUm = 1e-4;
constexpr Eigen::Index kSquare = 4;
constexpr Eigen::Index kLogK = 5;
constexpr Eigen::Index kLogWeight = 6;
constexpr double kMostLogK = 2.5;
constexpr double kMostLogWeight = 2.5;

Eigen::Index at(std::size_t i) { return static_cast<Eigen::Index>(i); }

// Residuals of the nodes, and two rows for the prior of a conic.
class Problem {
 public:
  using Scalar = double;
  using InputType = Eigen::VectorXd;
  using ValueType = Eigen::VectorXd;
  using JacobianType = Eigen::MatrixXd;
  enum { InputsAtCompileTime = Eigen::Dynamic, ValuesAtCompileTime = Eigen::Dynamic };

  Problem(const SectionData& section, const WindowProfile& window, Eigen::Index inputs, double prior)
      : section_(section),
        window_(window),
        whitening_(section.s_um, window.width_um()),
        inputs_(inputs),
        prior_(prior),
        root_(at(section.s_um.size())) {
    root_.setOnes();
  }

  [[nodiscard]] int inputs() const { return static_cast<int>(inputs_); }
  [[nodiscard]] int values() const { return static_cast<int>(nodes() + (inputs_ > kLogK ? 2 : 0)); }
  [[nodiscard]] Eigen::Index nodes() const { return at(section_.s_um.size()); }
  // What the nodes' heights do to the right side of the normal equations, one row a parameter.
  [[nodiscard]] Eigen::MatrixXd by_heights(Eigen::MatrixXd jacobian) const {
    whitening_.apply_transposed(jacobian);
    return (jacobian.topRows(nodes()).array().colwise() * root_.array()).transpose();
  }

  int operator()(const InputType& x, ValueType& residual) const {
    const AveragedContour contour(model_of(x), window_);
    for (std::size_t i = 0; i < section_.s_um.size(); ++i) {
      residual[at(i)] = root_[at(i)] * (contour.height_um(section_.s_um[i]) - section_.h_um[i]);
    }
    whitening_.apply(residual);
    if (inputs_ > kLogK) {
      residual[nodes()] = prior_ / kPriorLogK * x[kLogK];
      residual[nodes() + 1] = prior_ / kPriorLogWeight * x[kLogWeight];
    }
    return 0;
  }

  int df(const InputType& x, JacobianType& jacobian) const {
    jacobian.setZero();
    const AveragedContour contour(model_of(x), window_);
    Eigen::VectorXd heights(nodes());
    for (std::size_t i = 0; i < section_.s_um.size(); ++i) {
      jacobian(at(i), 0) = -root_[at(i)] * contour.slope(section_.s_um[i]);
      jacobian(at(i), 1) = root_[at(i)];
      heights[at(i)] = contour.height_um(section_.s_um[i]);
    }
    for (Eigen::Index k = 2; k < inputs_; ++k) {
      InputType moved = x;
      const double step = k == kSquare ? 1e-4 * (1.0 + std::abs(x[k])) : 1e-5;
      moved[k] += step;
      const AveragedContour other(model_of(moved), window_);
      for (std::size_t i = 0; i < section_.s_um.size(); ++i) {
        jacobian(at(i), k) = root_[at(i)] * (other.height_um(section_.s_um[i]) - heights[at(i)]) / step;
      }
    }
    whitening_.apply(jacobian);
    if (inputs_ > kLogK) {
      jacobian(nodes(), kLogK) = prior_ / kPriorLogK;
      jacobian(nodes() + 1, kLogWeight) = prior_ / kPriorLogWeight;
    }
    return 0;
  }

  // Weights of the next round, and the root mean square of the orthogonal distances.
  double reweigh(const InputType& x) {
    const AveragedContour contour(model_of(x), window_);
    const double typical = median(section_.weight);
    std::vector<double> distances;
    double squares = 0.0;
    double sum = 0.0;
    for (std::size_t i = 0; i < section_.s_um.size(); ++i) {
      const double slope = contour.slope(section_.s_um[i]);
      const double distance = (section_.h_um[i] - contour.height_um(section_.s_um[i])) / std::sqrt(1.0 + slope * slope);
      root_[at(i)] = std::sqrt(section_.weight[i] / typical);
      distances.push_back(std::abs(distance * root_[at(i)]));
      root_[at(i)] /= std::sqrt(1.0 + slope * slope);
      squares += section_.weight[i] * distance * distance;
      sum += section_.weight[i];
    }
    const double scale = std::max(kLeastNoiseUm, kSdPerMad * median(distances));
    for (std::size_t i = 0; i < distances.size(); ++i) {
      const double size = distances[i] / scale;
      if (size > kHuberCut) root_[at(i)] *= std::sqrt(kHuberCut / size);
    }
    return std::sqrt(squares / sum);
  }

 private:
  const SectionData& section_;
  const WindowProfile& window_;
  Whitening whitening_;
  Eigen::Index inputs_;
  double prior_;
  Eigen::VectorXd root_;
};

// The square of the size of the tangent circle that leaves the apex as far as the section does.
double first_square(const SectionData& section, const FlankLines& lines, const WindowProfile& window) {
  double nearest = 1e300;
  for (std::size_t i = 0; i < section.s_um.size(); ++i) {
    nearest = std::min(nearest, std::hypot(section.s_um[i] - lines.apex_s_um, section.h_um[i] - lines.apex_h_um));
  }
  // A sharp edge is lowered by the window as well.
  const double turn = std::tan(lines.rake_rad) + std::tan(lines.clearance_rad);
  const double by_window = turn / 2.0 * window.mean_distance_um(0.0);
  const double half = (std::numbers::pi - lines.rake_rad - lines.clearance_rad) / 2.0;
  const double radius = std::max(0.5, nearest - by_window) / (1.0 / std::sin(half) - 1.0);
  return std::pow(radius / std::tan(half), 2);
}

ModelVector start_of(const SectionData& section, const WindowProfile& window, RoundingShape shape,
                     const FlankLines& lines, const EdgeOptions& options, const SectionFit* start) {
  ModelVector x = ModelVector::Zero(shape == RoundingShape::kConic ? 7 : 5);
  if (start != nullptr) {
    x.head(5) = start->parameters.head(5);
    return x;
  }
  const double most = std::pow(options.flank_to_um / 2.0, 2);
  x.head(5) << lines.apex_s_um, lines.apex_h_um, lines.rake_rad, lines.clearance_rad,
      std::min(most, first_square(section, lines, window));
  return x;
}

bool is_inside(const SectionModel& model, const EdgeOptions& options) {
  const double turn = model.rake_rad + model.clearance_rad;
  if (!(turn > 0.05 && turn < 3.1) || std::abs(model.rake_rad) > 1.55 || std::abs(model.clearance_rad) > 1.55)
    return false;
  const Rounding rounding = model.rounding();
  const double left = model.apex_s_um - rounding.s_gamma_um * std::cos(model.rake_rad);
  const double right = model.apex_s_um + rounding.s_alpha_um * std::cos(model.clearance_rad);
  // A rest of both flanks must be left to tell their lines.
  return left > -0.9 * options.flank_to_um && right < 0.9 * options.flank_to_um;
}

}  // namespace

SectionModel model_of(const ModelVector& p) {
  SectionModel model{p[0], p[1], p[2], p[3], p[kSquare], 0.0, 0.0};
  model.log_weight = model.circle_log_weight();
  if (p.size() > kLogK) {
    model.log_k = std::clamp(p[kLogK], -kMostLogK, kMostLogK);
    model.log_weight += std::clamp(p[kLogWeight], -kMostLogWeight, kMostLogWeight);
  }
  return model;
}

SectionFit fit_section(const SectionData& section, const WindowProfile& window, RoundingShape shape,
                       const FlankLines& lines, const EdgeOptions& options, const SectionFit* start) {
  SectionFit fit;
  fit.parameters = start_of(section, window, shape, lines, options, start);
  if (at(section.s_um.size()) <= fit.parameters.size() || !is_inside(fit.model(), options)) return fit;
  Problem problem(section, window, fit.parameters.size(), std::max(kLeastNoiseUm, lines.noise_um));
  problem.reweigh(fit.parameters);
  for (int round = 0; round < kRobustRounds; ++round) {
    Eigen::LevenbergMarquardt<Problem> solver(problem);
    solver.parameters.maxfev = 60;
    solver.parameters.xtol = 1e-6;
    solver.parameters.ftol = 1e-8;
    solver.minimize(fit.parameters);
    if (!fit.parameters.allFinite() || !is_inside(fit.model(), options)) return fit;
    fit.residual_rms_um = problem.reweigh(fit.parameters);
  }
  Eigen::MatrixXd jacobian(problem.values(), problem.inputs());
  problem.df(fit.parameters, jacobian);
  const Eigen::MatrixXd normal = jacobian.transpose() * jacobian;
  const Eigen::LDLT<Eigen::MatrixXd> decomposed(normal);
  if (decomposed.info() != Eigen::Success || !(decomposed.vectorD().minCoeff() > 0.0)) return fit;
  fit.influence = decomposed.solve(problem.by_heights(jacobian));
  fit.good = true;
  return fit;
}

}  // namespace fvd::metrology::edge
