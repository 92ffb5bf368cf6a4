#include "core/metrology/edge/edge_statistics.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "core/metrology/edge/robust.hpp"

namespace fvd::metrology::edge {
namespace {

// sqrt(pi / 2): standard error of a median over that of a mean.
constexpr double kMedianOverMean = 1.2533141373155003;
// With fewer sections a median absolute deviation tells less than a standard deviation.
constexpr std::size_t kFewestForRobust = 8;
constexpr int kStepsPerSection = 40;

double spread(std::span<const double> values) {
  const std::vector<double> copy(values.begin(), values.end());
  if (values.size() >= kFewestForRobust) return robust_sd(copy);
  double mean = 0.0;
  for (const double value : values) mean += value / static_cast<double>(values.size());
  double squares = 0.0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  return std::sqrt(squares / static_cast<double>(values.size() - 1));
}

// A box of the window convolved with a box of the section.
double trapezoid(double x, double window, double every) {
  const double outer = (window + every) / 2.0;
  const double inner = std::abs(window - every) / 2.0;
  const double away = std::abs(x);
  if (away >= outer) return 0.0;
  return away <= inner ? 1.0 : (outer - away) / (outer - inner);
}

}  // namespace

double shared_noise(std::span<const double> along_um, double every_um, double window_um) {
  const auto most = static_cast<std::size_t>(std::ceil((window_um + every_um) / every_um));
  std::vector<double> covariance(most + 1, 0.0);
  const double step = every_um / kStepsPerSection;
  for (std::size_t lag = 0; lag <= most; ++lag) {
    const double shift = static_cast<double>(lag) * every_um;
    for (double x = -(window_um + every_um) / 2.0; x <= (window_um + every_um) / 2.0; x += step) {
      covariance[lag] += trapezoid(x, window_um, every_um) * trapezoid(x - shift, window_um, every_um);
    }
  }
  double sum = 0.0;
  for (std::size_t i = 0; i < along_um.size(); ++i) {
    sum += covariance[0];
    for (std::size_t j = i + 1; j < along_um.size(); ++j) {
      const auto lag = static_cast<std::size_t>(std::lround((along_um[j] - along_um[i]) / every_um));
      if (lag > most) break;
      sum += 2.0 * covariance[lag];
    }
  }
  return std::max(1.0, sum / covariance[0] / static_cast<double>(along_um.size()));
}

EdgeValue summarise(std::span<const double> values, std::span<const double> u_noise, double shared, bool squares) {
  assert(u_noise.empty() || u_noise.size() == values.size());
  EdgeValue value;
  std::vector<double> scaled(values.begin(), values.end());
  std::vector<double> noise(u_noise.begin(), u_noise.end());
  value.median = median(scaled);
  value.p10 = quantile(scaled, 0.1);
  value.p90 = quantile(scaled, 0.9);
  if (squares) {
    for (std::size_t i = 0; i < noise.size(); ++i) noise[i] *= noise[i] + 2.0 * std::abs(values[i]);
    for (double& v : scaled) v *= std::abs(v);
  }
  const auto from_square = [&](double u) {
    return squares ? std::sqrt(*value.median * *value.median + u) - std::abs(*value.median) : u;
  };
  // One value is its own median, and the median of two is their mean.
  const double factor = (values.size() > 2 ? kMedianOverMean : 1.0) / std::sqrt(static_cast<double>(values.size()));
  if (values.size() > 1) {
    const double error = factor * spread(scaled);
    value.standard_error = from_square(error);
    value.u = from_square(error * std::sqrt(shared));
  }
  if (!noise.empty()) {
    value.u_noise = from_square(factor * std::sqrt(shared) * median(std::move(noise)));
    value.u = std::max(value.u.value_or(0.0), *value.u_noise);
  }
  if (!value.u) value.u_reason = EdgeReason::kTooFewSections;
  return value;
}

}  // namespace fvd::metrology::edge
