#include "core/metrology/edge/section_values.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

namespace fvd::metrology::edge {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;

double smooth_figure(EdgeQuantity quantity, const SectionModel& model) {
  const double figure = figure_of(quantity, model);
  return is_length(quantity) ? figure * std::abs(figure) : figure;
}

}  // namespace

bool is_length(EdgeQuantity quantity) noexcept {
  return quantity == EdgeQuantity::kRadius || quantity == EdgeQuantity::kRadiusApparent ||
         quantity == EdgeQuantity::kSGamma || quantity == EdgeQuantity::kSAlpha || quantity == EdgeQuantity::kDeltaR ||
         quantity == EdgeQuantity::kRMin;
}

double figure_noise(EdgeQuantity quantity, double figure, double u) {
  return is_length(quantity) ? std::sqrt(figure * figure + u) - std::abs(figure) : u;
}

double figure_of(EdgeQuantity quantity, const SectionModel& model) {
  const double sign = model.signed_square_um2 < 0.0 ? -1.0 : 1.0;
  const Rounding rounding = model.rounding();
  switch (quantity) {
    case EdgeQuantity::kRadius:
    case EdgeQuantity::kRadiusApparent:
      return model.signed_radius_um();
    case EdgeQuantity::kBeta:
      return model.beta_rad() * kDegrees;
    case EdgeQuantity::kSGamma:
      return sign * rounding.s_gamma_um;
    case EdgeQuantity::kSAlpha:
      return sign * rounding.s_alpha_um;
    case EdgeQuantity::kK:
      return std::exp(model.log_k);
    case EdgeQuantity::kDeltaR:
      return sign * nearest_to_apex(rounding).delta_r_um;
    case EdgeQuantity::kPhi:
      return nearest_to_apex(rounding).phi_deg;
    case EdgeQuantity::kRMin:
      return sign * least_radius_um(rounding);
    case EdgeQuantity::kResidualRms:
      break;
  }
  return 0.0;
}

Eigen::VectorXd influence_on(EdgeQuantity quantity, const SectionFit& fit) {
  Eigen::VectorXd gradient(fit.parameters.size());
  for (Eigen::Index k = 0; k < gradient.size(); ++k) {
    const double step = k == 4 ? 1e-3 * (1.0 + std::abs(fit.parameters[k])) : 1e-4;
    ModelVector up = fit.parameters;
    ModelVector down = fit.parameters;
    up[k] += step;
    down[k] -= step;
    gradient[k] = (smooth_figure(quantity, model_of(up)) - smooth_figure(quantity, model_of(down))) / (2.0 * step);
  }
  return fit.influence.transpose() * gradient;
}

Eigen::VectorXd noise_of(const Eigen::MatrixXd& influences, const SectionData& section, const HeightField& field) {
  const int reach = field.kernel.reach_px();
  int left = field.width();
  int right = 0;
  int top = field.height();
  int bottom = 0;
  for (const SectionPoint& p : section.points) {
    left = std::min(left, p.column);
    right = std::max(right, p.column);
    top = std::min(top, p.row);
    bottom = std::max(bottom, p.row);
  }
  const Eigen::Index figures = influences.cols();
  if (section.points.empty()) return Eigen::VectorXd::Zero(figures);
  // A patch of the image about the section; each column is a white error's effect on all figures.
  const int width = right - left + 1 + 2 * reach;
  const int height = bottom - top + 1 + 2 * reach;
  Eigen::MatrixXd effect = Eigen::MatrixXd::Zero(figures, static_cast<Eigen::Index>(width) * height);
  const Eigen::MatrixXd by_figure = influences.transpose();
  for (const SectionPoint& p : section.points) {
    const double sigma = static_cast<double>(field.sigma_um.at(p.column, p.row));
    const Eigen::VectorXd own = by_figure.col(p.node) * (p.share * sigma);
    for (int j = 0; j <= 2 * reach; ++j) {
      const double weight_y = field.kernel.weights[static_cast<std::size_t>(j)];
      Eigen::Index place = static_cast<Eigen::Index>(p.row - top + j) * width + (p.column - left);
      for (int i = 0; i <= 2 * reach; ++i, ++place) {
        effect.col(place).noalias() += own * (weight_y * field.kernel.weights[static_cast<std::size_t>(i)]);
      }
    }
  }
  double squares = 0.0;
  for (const double weight : field.kernel.weights) squares += weight * weight;
  return effect.rowwise().squaredNorm().cwiseSqrt() / squares;
}

}  // namespace fvd::metrology::edge
