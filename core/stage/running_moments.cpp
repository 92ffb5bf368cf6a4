#include "core/stage/running_moments.hpp"

#include <algorithm>
#include <cmath>

namespace fvd {

void RunningMoments::add(double value) {
  ++n;
  const double off = value - mean;
  mean += off / static_cast<double>(n);
  sum_of_squares += off * (value - mean);
  max_magnitude = std::max(max_magnitude, std::abs(value));
}

void RunningMoments::merge(const RunningMoments& other) {
  if (other.n == 0) return;
  const auto mine = static_cast<double>(n);
  const auto theirs = static_cast<double>(other.n);
  const double off = other.mean - mean;
  n += other.n;
  mean += off * theirs / (mine + theirs);
  sum_of_squares += other.sum_of_squares + off * off * mine * theirs / (mine + theirs);
  max_magnitude = std::max(max_magnitude, other.max_magnitude);
}

std::optional<double> RunningMoments::sd() const {
  if (n < 2) return std::nullopt;
  return std::sqrt(sum_of_squares / static_cast<double>(n - 1));
}

bool RunningMoments::consistent() const {
  const bool numbers = std::isfinite(mean) && std::isfinite(sum_of_squares) && std::isfinite(max_magnitude);
  constexpr double kRounding = 1e-9;
  if (!numbers || sum_of_squares < 0.0 || std::abs(mean) > max_magnitude * (1 + kRounding)) return false;
  return n > 0 || (sum_of_squares == 0.0 && max_magnitude == 0.0);
}

}  // namespace fvd
