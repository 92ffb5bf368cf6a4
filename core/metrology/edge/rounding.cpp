#include "core/metrology/edge/rounding.hpp"

#include <cmath>
#include <numbers>

namespace fvd::metrology::edge {
namespace {

constexpr int kPlaces = 48;

// The smallest value of a smooth function over u in 0..1: the best of a grid, narrowed by the golden section.
template <typename Function>
double place_of_least(const Function& function) {
  int best = 0;
  for (int i = 1; i <= kPlaces; ++i) {
    if (function(static_cast<double>(i) / kPlaces) < function(static_cast<double>(best) / kPlaces)) best = i;
  }
  double low = std::fmax(0.0, (best - 1.0) / kPlaces);
  double high = std::fmin(1.0, (best + 1.0) / kPlaces);
  constexpr double kGolden = 0.6180339887498949;
  for (int round = 0; round < 40; ++round) {
    const double left = high - kGolden * (high - low);
    const double right = low + kGolden * (high - low);
    if (function(left) < function(right)) {
      high = right;
    } else {
      low = left;
    }
  }
  const double inside = (low + high) / 2.0;
  const double end = inside < 0.5 ? 0.0 : 1.0;
  return function(end) <= function(inside) ? end : inside;
}

// The curve in the skew coordinates of the wedge: shares of the rake's and of the clearance's direction, apex at 0.
struct Shares {
  double rake, clearance;
};

Shares shares_at(const Rounding& rounding, double u) {
  const double v = 1.0 - u;
  const double denominator = v * v + 2.0 * u * v * rounding.weight + u * u;
  return {rounding.s_gamma_um * v * v / denominator, rounding.s_alpha_um * u * u / denominator};
}

}  // namespace

Rounding Rounding::circle(double beta_rad, double radius_um) {
  const double s = radius_um / std::tan(beta_rad / 2.0);
  return {beta_rad, s, s, std::sin(beta_rad / 2.0)};
}

NearestPoint nearest_to_apex(const Rounding& rounding) {
  const double cosine = std::cos(rounding.beta_rad);
  const auto squared_distance = [&](double u) {
    const Shares p = shares_at(rounding, u);
    return p.rake * p.rake + p.clearance * p.clearance + 2.0 * p.rake * p.clearance * cosine;
  };
  const double u = place_of_least(squared_distance);
  const Shares p = shares_at(rounding, u);
  // Along the bisector both directions count cos(beta / 2). Where the rounding reaches further along the rake, the
  // nearest point lies on the clearance's side of the bisector, and the edge has moved towards the rake: positive.
  const double along = (p.rake + p.clearance) * std::cos(rounding.beta_rad / 2.0);
  const double across = (p.clearance - p.rake) * std::sin(rounding.beta_rad / 2.0);
  return {std::sqrt(squared_distance(u)), std::atan2(across, along) * 180.0 / std::numbers::pi};
}

double least_radius_um(const Rounding& rounding) {
  const double g = rounding.s_gamma_um;
  const double a = rounding.s_alpha_um;
  const double w = rounding.weight;
  const double cosine = std::cos(rounding.beta_rad);
  // det(H, H', H'') = 4 w g a sin(beta) all along; (X'W - XW', Y'W - YW') is twice the direction below.
  const auto radius = [&](double u) {
    const double v = 1.0 - u;
    const double from_rake = g * v * (w * v + u);
    const double to_clearance = a * u * (v + w * u);
    const double speed =
        std::sqrt(from_rake * from_rake + to_clearance * to_clearance - 2.0 * from_rake * to_clearance * cosine);
    const double denominator = v * v + 2.0 * u * v * w + u * u;
    return 2.0 * std::pow(speed / denominator, 3) / w;
  };
  return radius(place_of_least(radius)) / (g * a * std::sin(rounding.beta_rad));
}

}  // namespace fvd::metrology::edge
