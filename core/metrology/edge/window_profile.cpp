#include "core/metrology/edge/window_profile.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace fvd::metrology::edge {
namespace {

constexpr int kStepsPerPixel = 16;
// A side of a projected pixel that is shorter than this share of the other is a line: differences of cubes lose their
// digits there.
constexpr double kThinSide = 1e-3;

// The function of mean |s - t| over one projected pixel centred at 0, with sides a >= b, and its derivatives. A pixel
// seen at an angle is a box of a convolved with a box of b: the fourth difference of |s|^3 / 6.
struct PixelFunction {
  double a, b;

  // The n-th derivative, n = 0, 1 or 2; the second one is twice the density.
  [[nodiscard]] double operator()(double s, int n) const {
    if (b < kThinSide * a) return (anti(s + a / 2, n, 2) - anti(s - a / 2, n, 2)) / a;
    const double outer = (a + b) / 2;
    const double inner = (a - b) / 2;
    return (anti(s + outer, n, 3) - anti(s + inner, n, 3) - anti(s - inner, n, 3) + anti(s - outer, n, 3)) / (a * b);
  }

 private:
  // The n-th derivative of the function whose (order - 1)-th derivative is |s|.
  static double anti(double s, int n, int order) {
    const double sign = s < 0.0 ? -1.0 : 1.0;
    switch (order - n) {
      case 3:
        return std::abs(s) * s * s / 6.0;
      case 2:
        return s * std::abs(s) / 2.0;
      case 1:
        return std::abs(s);
      default:
        return sign;
    }
  }
};

// The weights through which the surface is seen: of the operator's spread half lies on each side, as near as it can.
std::vector<double> seen_weights(const LateralKernel& kernel) {
  if (kernel.operator_px2 == 0.0) return kernel.weights;
  const auto away = static_cast<std::size_t>(std::ceil(std::sqrt(kernel.operator_px2)));
  const double aside = kernel.operator_px2 / (2.0 * static_cast<double>(away * away));
  std::vector<double> seen(kernel.weights.size() + 2 * away, 0.0);
  for (std::size_t i = 0; i < kernel.weights.size(); ++i) {
    seen[i] += aside * kernel.weights[i];
    seen[i + away] += (1.0 - 2.0 * aside) * kernel.weights[i];
    seen[i + 2 * away] += aside * kernel.weights[i];
  }
  return seen;
}

// The n-th derivative of the mean of |s - t| over all pixels of the window.
double projected(const std::vector<double>& weights, const PixelFunction& pixel, double side_x, double side_y, double s,
                 int n) {
  const int reach_px = static_cast<int>(weights.size() / 2);
  double sum = 0.0;
  for (int j = -reach_px; j <= reach_px; ++j) {
    for (int i = -reach_px; i <= reach_px; ++i) {
      const double weight =
          weights[static_cast<std::size_t>(i + reach_px)] * weights[static_cast<std::size_t>(j + reach_px)];
      sum += weight * pixel(s - i * side_x - j * side_y, n);
    }
  }
  return sum;
}

double width_of(const std::vector<double>& weights, const PixelFunction& pixel, double side_x, double side_y) {
  const double step = pixel.a / kStepsPerPixel;
  const double reach = static_cast<double>(weights.size()) / 2.0 * (side_x + side_y);
  double squares = 0.0;
  for (int n = 0; n <= static_cast<int>(std::ceil(reach / step)); ++n) {
    // Between the nodes: a box steps at a node.
    const double density = projected(weights, pixel, side_x, side_y, (n + 0.5) * step, 2) / 2.0;
    squares += 2.0 * density * density * step;
  }
  return 1.0 / squares;
}

}  // namespace

WindowProfile::WindowProfile(const LateralKernel& kernel, double pitch_x_um, double pitch_y_um, double direction_x,
                             double direction_y) {
  const double side_x = std::abs(direction_x) * pitch_x_um;
  const double side_y = std::abs(direction_y) * pitch_y_um;
  const PixelFunction pixel{std::max(side_x, side_y), std::min(side_x, side_y)};
  step_um_ = pixel.a / kStepsPerPixel;
  width_um_ = width_of(kernel.weights, pixel, side_x, side_y);
  const std::vector<double> seen = seen_weights(kernel);
  reach_um_ = static_cast<double>(seen.size()) / 2.0 * (side_x + side_y);
  const int nodes = static_cast<int>(std::ceil(reach_um_ / step_um_)) + 1;
  distance_.assign(static_cast<std::size_t>(nodes), 0.0);
  sign_.assign(static_cast<std::size_t>(nodes), 0.0);
  for (int n = 0; n < nodes; ++n) {
    const auto at = static_cast<std::size_t>(n);
    distance_[at] = projected(seen, pixel, side_x, side_y, n * step_um_, 0);
    sign_[at] = projected(seen, pixel, side_x, side_y, n * step_um_, 1);
  }
}

double WindowProfile::mean_distance_um(double s_um) const {
  const double s = std::abs(s_um);
  const double place = s / step_um_;
  const auto i = static_cast<std::size_t>(place);
  if (i + 1 >= distance_.size()) return s;
  const double t = place - static_cast<double>(i);
  const double r = 1.0 - t;
  // Cubic Hermite: values and slopes of both nodes are exact.
  return r * r * ((1.0 + 2.0 * t) * distance_[i] + t * step_um_ * sign_[i]) +
         t * t * ((3.0 - 2.0 * t) * distance_[i + 1] - r * step_um_ * sign_[i + 1]);
}

double WindowProfile::mean_sign(double s_um) const {
  const double place = std::abs(s_um) / step_um_;
  const auto i = static_cast<std::size_t>(place);
  if (i + 1 >= sign_.size()) return s_um < 0.0 ? -1.0 : 1.0;
  const double t = place - static_cast<double>(i);
  const double value = (1.0 - t) * sign_[i] + t * sign_[i + 1];
  return s_um < 0.0 ? -value : value;
}

}  // namespace fvd::metrology::edge
