#include "core/metrology/edge/section_model.hpp"

#include <array>
#include <cstddef>

namespace fvd::metrology::edge {
namespace {

constexpr int kNodes = 24;

struct Quadrature {
  std::array<double, kNodes> node;
  std::array<double, kNodes> weight;
};

// Gauss-Legendre on 0..1, by Newton's iteration on the Legendre polynomial.
Quadrature make_quadrature() {
  Quadrature rule{};
  for (int i = 0; i < kNodes; ++i) {
    double x = std::cos(std::numbers::pi * (i + 0.75) / (kNodes + 0.5));
    double derivative = 1.0;
    for (int round = 0; round < 8; ++round) {
      double before = 1.0;
      double value = x;
      for (int n = 2; n <= kNodes; ++n) {
        const double next = ((2 * n - 1) * x * value - (n - 1) * before) / n;
        before = value;
        value = next;
      }
      derivative = kNodes * (x * value - before) / (x * x - 1.0);
      x -= value / derivative;
    }
    const auto at = static_cast<std::size_t>(i);
    rule.node[at] = (1.0 - x) / 2.0;
    rule.weight[at] = 1.0 / ((1.0 - x * x) * derivative * derivative);
  }
  return rule;
}

}  // namespace

Rounding SectionModel::rounding() const {
  const double size = std::abs(signed_size_um());
  return {beta_rad(), size * std::exp(log_k / 2.0), size * std::exp(-log_k / 2.0), std::exp(log_weight)};
}

AveragedContour::AveragedContour(const SectionModel& model, const WindowProfile& window)
    : model_(model), window_(&window) {
  static const Quadrature kRule = make_quadrature();
  const double rise = std::tan(model.rake_rad);
  const double fall = std::tan(model.clearance_rad);
  mean_slope_ = (rise - fall) / 2.0;
  half_drop_ = (rise + fall) / 2.0;
  const Rounding r = model.rounding();
  // The curve's direction is a share of a = apex - start, and a share of b = end - apex.
  const double ax = r.s_gamma_um * std::cos(model.rake_rad);
  const double bx = r.s_alpha_um * std::cos(model.clearance_rad);
  left_um_ = -ax - window.reach_um();
  right_um_ = bx + window.reach_um();
  if (ax + bx <= 0.0) return;
  const double cross = -ax * bx * (rise + fall);
  const double w = r.weight;
  double sum = 0.0;
  kinks_.reserve(kNodes);
  for (std::size_t i = 0; i < kNodes; ++i) {
    const double u = kRule.node[i];
    const double v = 1.0 - u;
    const double share_a = v * (w * v + u);
    const double share_b = u * (v + w * u);
    const double turn = w * (v * v + u * u) + 2.0 * w * w * u * v;  // share_a share_b' - share_a' share_b
    const double dx = share_a * ax + share_b * bx;
    const double drop = -kRule.weight[i] * turn * cross / (dx * dx);
    const double denominator = v * v + 2.0 * u * v * w + u * u;
    kinks_.push_back({(u * u * bx - v * v * ax) / denominator, drop / 2.0});
    sum += drop / 2.0;
  }
  // The sum of all kinks is the whole turn, and their centre is the apex, whatever the spacing leaves.
  double centre = 0.0;
  for (Kink& kink : kinks_) {
    kink.half_drop *= half_drop_ / sum;
    centre += kink.s_um * kink.half_drop / half_drop_;
  }
  for (Kink& kink : kinks_) kink.s_um -= centre;
}

double AveragedContour::height_um(double s_um) const {
  const double x = s_um - model_.apex_s_um;
  const double line = model_.apex_h_um + mean_slope_ * x;
  if (x <= left_um_ || x >= right_um_) return line - half_drop_ * std::abs(x);
  const double sharp = half_drop_ * window_->mean_distance_um(x);
  if (kinks_.empty()) return line - sharp;
  double rounded = 0.0;
  for (const Kink& kink : kinks_) rounded += kink.half_drop * window_->mean_distance_um(x - kink.s_um);
  return line - (model_.signed_square_um2 >= 0.0 ? rounded : 2.0 * sharp - rounded);
}

double AveragedContour::slope(double s_um) const {
  const double x = s_um - model_.apex_s_um;
  if (x <= left_um_) return mean_slope_ + half_drop_;
  if (x >= right_um_) return mean_slope_ - half_drop_;
  const double sharp = half_drop_ * window_->mean_sign(x);
  if (kinks_.empty()) return mean_slope_ - sharp;
  double rounded = 0.0;
  for (const Kink& kink : kinks_) rounded += kink.half_drop * window_->mean_sign(x - kink.s_um);
  return mean_slope_ - (model_.signed_square_um2 >= 0.0 ? rounded : 2.0 * sharp - rounded);
}

}  // namespace fvd::metrology::edge
