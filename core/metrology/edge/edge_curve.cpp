#include "core/metrology/edge/edge_curve.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace fvd::metrology::edge {
namespace {

constexpr int kLengthSteps = 256;
// A degree is fitted only to three times as many places as it has coefficients.
constexpr int kPlacesPerCoefficient = 3;

double value_beyond(const Polynomial& polynomial, double x) {
  const double inside = std::clamp(x, polynomial.centre - polynomial.half, polynomial.centre + polynomial.half);
  return polynomial(inside) + polynomial.slope(inside) * (x - inside);
}

double slope_beyond(const Polynomial& polynomial, double x) {
  return polynomial.slope(std::clamp(x, polynomial.centre - polynomial.half, polynomial.centre + polynomial.half));
}

// The last place towards `outer` that is inside.
template <typename Inside>
double border(const Inside& inside, double inner, double outer) {
  for (int round = 0; round < 20; ++round) {
    const double middle = (inner + outer) / 2.0;
    (inside(middle) ? inner : outer) = middle;
  }
  return inner;
}

}  // namespace

SpacePoint EdgeFrame::at(double s_um, double h_um) const {
  const double along = -tilt * h_um / stretch;
  return {x + s_um * u_x + along * e_x, y + s_um * u_y + along * e_y, z + h_um / stretch};
}

bool is_in_region(const HeightField& field, const Region& region, double x_um, double y_um) {
  const double column = std::floor(x_um / field.pitch_x_um);
  const double row = std::floor(y_um / field.pitch_y_um);
  if (column < 0.0 || row < 0.0 || column >= field.width() || row >= field.height()) return false;
  return is_inside(region, static_cast<int>(column), static_cast<int>(row));
}

EdgeCurve::EdgeCurve(const StraightEdge& straight, const HeightField& field, const Region& region)
    : straight_(straight) {
  height_.coefficients = {straight.origin_z_um, straight.tilt};
  cut(field, region);
}

void EdgeCurve::fit(std::span<const SpacePoint> points, int degree, const HeightField& field, const Region& region) {
  std::vector<double> places;
  std::vector<double> across;
  std::vector<double> heights;
  for (const SpacePoint& p : points) {
    const double dx = p.x - straight_.origin_x_um;
    const double dy = p.y - straight_.origin_y_um;
    places.push_back(dx * straight_.e_x + dy * straight_.e_y);
    across.push_back(dx * straight_.u_x + dy * straight_.u_y);
    heights.push_back(p.z);
  }
  const int most = std::max(1, static_cast<int>(points.size()) / kPlacesPerCoefficient - 1);
  if (points.size() < 2) return;
  across_ = robust_polynomial(places, across, std::min(degree, most));
  height_ = robust_polynomial(places, heights, std::min(degree, most));
  cut(field, region);
}

void EdgeCurve::cut(const HeightField& field, const Region& region) {
  const double step = std::min(field.pitch_x_um, field.pitch_y_um) / 2.0;
  const double reach = std::hypot(field.width() * field.pitch_x_um, field.height() * field.pitch_y_um);
  from_um_ = to_um_ = 0.0;
  bool found = false;
  const auto inside = [&](double place) {
    const double across = value_beyond(across_, place);
    return is_in_region(field, region, straight_.origin_x_um + place * straight_.e_x + across * straight_.u_x,
                        straight_.origin_y_um + place * straight_.e_y + across * straight_.u_y);
  };
  for (double place = -reach; place <= reach; place += step) {
    if (!inside(place)) continue;
    if (!found) from_um_ = place;
    to_um_ = place;
    found = true;
  }
  if (found) {
    from_um_ = border(inside, from_um_, from_um_ - step);
    to_um_ = border(inside, to_um_, to_um_ + step);
  }
  measure_length();
}

void EdgeCurve::measure_length() {
  lengths_.assign(1, 0.0);
  most_across_um_ = std::abs(value_beyond(across_, from_um_));
  const double step = (to_um_ - from_um_) / kLengthSteps;
  for (int i = 0; i < kLengthSteps; ++i) {
    const double middle = from_um_ + (i + 0.5) * step;
    most_across_um_ = std::max(most_across_um_, std::abs(value_beyond(across_, middle + step / 2.0)));
    const double across = slope_beyond(across_, middle);
    const double rise = slope_beyond(height_, middle);
    lengths_.push_back(lengths_.back() + step * std::sqrt(1.0 + across * across + rise * rise));
  }
}

double EdgeCurve::length_um(double place_um) const {
  const double place = (place_um - from_um_) / (to_um_ - from_um_) * kLengthSteps;
  const int i = std::clamp(static_cast<int>(std::floor(place)), 0, kLengthSteps - 1);
  const auto at = static_cast<std::size_t>(i);
  return lengths_[at] + (place - i) * (lengths_[at + 1] - lengths_[at]);
}

double EdgeCurve::place_at_length(double length_um) const {
  const auto above = std::upper_bound(lengths_.begin() + 1, lengths_.end() - 1, length_um);
  const auto i = static_cast<double>(above - lengths_.begin() - 1);
  const double share = (length_um - *(above - 1)) / (*above - *(above - 1));
  return from_um_ + (i + share) / kLengthSteps * (to_um_ - from_um_);
}

EdgeFrame EdgeCurve::frame(double place_um) const {
  const double across = value_beyond(across_, place_um);
  const double bend = slope_beyond(across_, place_um);
  const double norm = std::sqrt(1.0 + bend * bend);
  EdgeFrame frame;
  frame.x = straight_.origin_x_um + place_um * straight_.e_x + across * straight_.u_x;
  frame.y = straight_.origin_y_um + place_um * straight_.e_y + across * straight_.u_y;
  frame.z = value_beyond(height_, place_um);
  frame.e_x = (straight_.e_x + bend * straight_.u_x) / norm;
  frame.e_y = (straight_.e_y + bend * straight_.u_y) / norm;
  frame.u_x = (straight_.u_x - bend * straight_.e_x) / norm;
  frame.u_y = (straight_.u_y - bend * straight_.e_y) / norm;
  frame.tilt = slope_beyond(height_, place_um) / norm;
  frame.stretch = std::sqrt(1.0 + frame.tilt * frame.tilt);
  return frame;
}

bool EdgeCurve::may_be_within(double x_um, double y_um, double distance_um) const {
  const double across = (x_um - straight_.origin_x_um) * straight_.u_x + (y_um - straight_.origin_y_um) * straight_.u_y;
  // A little more for what the bend does between the places looked at.
  return std::abs(across) <= 1.01 * (distance_um + most_across_um_);
}

EdgePlace EdgeCurve::place_of(double x_um, double y_um) const {
  const double dx = x_um - straight_.origin_x_um;
  const double dy = y_um - straight_.origin_y_um;
  const double along = dx * straight_.e_x + dy * straight_.e_y;
  const double across = dx * straight_.u_x + dy * straight_.u_y;
  double place = along;
  // The foot of the perpendicular; the bend is slight, so that the fixed point is near after few rounds.
  for (int round = 0; round < 3; ++round) {
    const double bend = slope_beyond(across_, place);
    const double miss = (place - along) + (value_beyond(across_, place) - across) * bend;
    place -= miss / (1.0 + bend * bend);
  }
  const double bend = slope_beyond(across_, place);
  const double s = (across - value_beyond(across_, place) - bend * (along - place)) / std::sqrt(1.0 + bend * bend);
  return {place, s};
}

}  // namespace fvd::metrology::edge
