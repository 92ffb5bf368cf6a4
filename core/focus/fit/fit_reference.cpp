#include "core/focus/fit/fit_reference.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <Eigen/Dense>

#include "core/focus/kernels/five_sample_fit.hpp"

namespace fvd {

namespace {

constexpr int kMostSamples = 5;

// Of at most five samples, so that nothing is allocated.
using Column = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMostSamples, 1>;
using Design = Eigen::Matrix<double, Eigen::Dynamic, 3, 0, kMostSamples, 3>;
using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMostSamples, kMostSamples>;
using Solution = Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, kMostSamples>;

/// What VertexBias says of a vertex at u between its neighbours.
double bias_at(const VertexBias& bias, double u, double u_left, double u_right, double bend) {
  const double within_half_a_step = std::clamp(u, -0.5, 0.5);
  const double fading = std::min(1.0, 4.0 / 3.0 * (u - u_left) * (u_right - u));
  return (static_cast<double>(bias.linear) * within_half_a_step +
          static_cast<double>(bias.cubic) * std::pow(within_half_a_step, 3)) *
         bend * fading;
}

}  // namespace

std::optional<ReferencePeak> fit_reference(const ReferenceCurve& curve) {
  std::array<ReferenceSample, kMostSamples> samples{curve.peak, curve.left, curve.right};
  Eigen::Index count = 3;
  if (curve.left2) samples[static_cast<std::size_t>(count++)] = *curve.left2;
  if (curve.right2) samples[static_cast<std::size_t>(count++)] = *curve.right2;
  const double step_um =
      (std::abs(curve.left.z_um - curve.peak.z_um) + std::abs(curve.right.z_um - curve.peak.z_um)) / 2;
  const double floor = static_cast<double>(kFloorShare) * curve.minimum;
  const double amplitude = curve.peak.share - floor;

  // G = r^-1/2 = k0 + k1 u + k2 u^2 with the weights r^4, r the sample as a
  // share of the peak.
  Design design(count, 3);
  Column root_weights(count);
  Column values(count);
  Column value_sigmas(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const ReferenceSample& sample = samples[static_cast<std::size_t>(i)];
    const double u = (sample.z_um - curve.peak.z_um) / step_um;
    const double r = std::max((sample.share - floor) / amplitude, static_cast<double>(kSmallestShare));
    design.row(i) << 1.0, u, u * u;
    root_weights(i) = r * r;
    values(i) = 1.0 / std::sqrt(r);
    value_sigmas(i) =
        std::hypot(curve.noise / amplitude, curve.misfit) / (2.0 * r * std::sqrt(r));  // dG = r^-3/2 dr / 2
  }
  // k = solution * G. The rows are scaled by the weights' roots, so that their
  // squares are least.
  const Design weighted = root_weights.asDiagonal() * design;
  const Square scale = root_weights.asDiagonal();
  const Solution solution = weighted.colPivHouseholderQr().solve(scale);
  const Eigen::Vector3d k = solution * values;
  if (!(k(2) > 0.0)) return std::nullopt;
  const double u = -k(1) / (2.0 * k(2));
  const double u_left = (curve.left.z_um - curve.peak.z_um) / step_um;
  const double u_right = (curve.right.z_um - curve.peak.z_um) / step_um;
  if (u < std::min(u_left, u_right) || u > std::max(u_left, u_right)) return std::nullopt;

  const Column by_value = (-solution.row(1) / (2.0 * k(2)) + k(1) / (2.0 * k(2) * k(2)) * solution.row(2)).transpose();
  const double noise = by_value.cwiseProduct(value_sigmas).norm();
  const double bend = k(2) / (1.0 + 0.9 * k(2));
  return ReferencePeak{curve.peak.z_um + step_um * (u - bias_at(curve.bias, u, u_left, u_right, bend)),
                       step_um * std::hypot(noise, curve.shape_error * bend)};
}

}  // namespace fvd
