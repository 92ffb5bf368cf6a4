#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <sstream>
#include <vector>

#include "core/metrology/areal/autocorrelation.hpp"

namespace fvd::metrology {
namespace {

constexpr int kDirections = 720;  // of half a turn; the function is the same after half a turn
constexpr double kStepPitches = 0.5;
constexpr int kHalvings = 60;    // of a step: to the last bit
constexpr int kNarrowings = 50;  // of an angle of half a degree
constexpr double kGolden = 0.6180339887498949;

double direction_rad(int index) { return std::numbers::pi * index / kDirections; }

/// The greatest of sign * fall within a step of directions on both sides of the given one, by golden section; infinite
/// where the function does not fall in a direction that is tried.
double refine(const Autocorrelation& function, double threshold, int index, double coarse_um, double sign) {
  const auto score = [&](double direction) {
    const std::optional<double> fall_um = function.fall_um(direction, threshold);
    return fall_um ? sign * *fall_um : std::numeric_limits<double>::infinity();
  };
  double low = direction_rad(index - 1);
  double high = direction_rad(index + 1);
  double left = high - kGolden * (high - low);
  double right = low + kGolden * (high - low);
  double left_score = score(left);
  double right_score = score(right);
  double best = std::max({sign * coarse_um, left_score, right_score});
  for (int i = 0; i < kNarrowings; ++i) {
    if (left_score > right_score) {
      high = right;
      right = left;
      right_score = left_score;
      left = high - kGolden * (high - low);
      left_score = score(left);
    } else {
      low = left;
      left = right;
      left_score = right_score;
      right = low + kGolden * (high - low);
      right_score = score(right);
    }
    best = std::max({best, left_score, right_score});
  }
  return sign * best;
}

std::string never_falls(double threshold, int index) {
  // Directions are told as they are seen, counter-clockwise from x; y goes down.
  const double seen_deg = index == 0 ? 0.0 : 180.0 - 180.0 * index / kDirections;
  std::ostringstream text;
  text << "the autocorrelation does not fall to " << threshold << " in the direction of " << seen_deg
       << " deg within the lags that have a quarter of the pairs";
  return text.str();
}

}  // namespace

std::optional<double> Autocorrelation::fall_um(double direction_rad, double threshold) const {
  const double along_x = std::cos(direction_rad);
  const double along_y = std::sin(direction_rad);
  const double step_um = kStepPitches * std::min(pitch_x_um_, pitch_y_um_);
  const auto value_at = [&](double distance_um) { return at_um(distance_um * along_x, distance_um * along_y); };
  for (int step = 1;; ++step) {
    const std::optional<double> value = value_at(step * step_um);
    if (!value) return std::nullopt;
    if (*value > threshold) continue;
    double above_um = (step - 1) * step_um;
    double below_um = step * step_um;
    for (int i = 0; i < kHalvings; ++i) {
      const double middle_um = 0.5 * (above_um + below_um);
      const std::optional<double> middle = value_at(middle_um);
      (middle && *middle > threshold ? above_um : below_um) = middle_um;
    }
    return below_um;
  }
}

std::pair<std::optional<AutocorrelationLengths>, std::string> autocorrelation_lengths(const Autocorrelation& function,
                                                                                      double threshold) {
  std::vector<double> falls_um;
  falls_um.reserve(kDirections);
  for (int index = 0; index < kDirections; ++index) {
    const std::optional<double> fall_um = function.fall_um(direction_rad(index), threshold);
    if (!fall_um) return {std::nullopt, never_falls(threshold, index)};
    falls_um.push_back(*fall_um);
  }
  const auto [shortest, longest] = std::minmax_element(falls_um.begin(), falls_um.end());
  const auto at_shortest = static_cast<int>(shortest - falls_um.begin());
  const auto at_longest = static_cast<int>(longest - falls_um.begin());
  const AutocorrelationLengths lengths{refine(function, threshold, at_shortest, *shortest, -1.0),
                                       refine(function, threshold, at_longest, *longest, 1.0)};
  if (!std::isfinite(lengths.shortest_um)) return {std::nullopt, never_falls(threshold, at_shortest)};
  if (!std::isfinite(lengths.longest_um)) return {std::nullopt, never_falls(threshold, at_longest)};
  return {lengths, {}};
}

}  // namespace fvd::metrology
