#include "core/focus/fit/slice_sensitivity.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>

#include "core/focus/fit/fit_reference.hpp"

namespace fvd {

namespace {

constexpr int kPartsOfAStep = 32;
constexpr int kReach = 2;         ///< samples on each side of the peak that the fit takes
constexpr double kMove = 1e-4;    ///< of a step: small against the curve, large against rounding
constexpr double kNoise = 0.005;  ///< of full scale; the fit's weights hardly depend on it

/// z of the neighbours of sample `centre`, and what was seen at their true heights.
struct Window {
  std::array<double, 2 * kReach + 1> z_um{};
  std::array<double, 2 * kReach + 1> share{};
  std::array<bool, 2 * kReach + 1> exists{};

  [[nodiscard]] std::optional<double> fitted_um() const {
    const auto sample = [this](std::size_t i) { return ReferenceSample{z_um[i], share[i]}; };
    ReferenceCurve curve{.peak = sample(2), .left = sample(1), .right = sample(3), .noise = kNoise};
    if (exists[0]) curve.left2 = sample(0);
    if (exists[4]) curve.right2 = sample(4);
    const auto peak = fit_reference(curve);
    return peak ? std::optional(peak->z_um) : std::nullopt;
  }
};

std::optional<Window> window_about(std::span<const double> z_um, std::size_t centre, double height_um,
                                   double width_um) {
  if (centre < 1 || centre + 1 >= z_um.size()) return std::nullopt;
  Window window;
  for (int offset = -kReach; offset <= kReach; ++offset) {
    const auto index = static_cast<std::ptrdiff_t>(centre) + offset;
    if (index < 0 || index >= static_cast<std::ptrdiff_t>(z_um.size())) continue;
    const auto at = static_cast<std::size_t>(offset + kReach);
    window.exists[at] = true;
    window.z_um[at] = z_um[static_cast<std::size_t>(index)];
    const double u = (window.z_um[at] - height_um) / width_um;
    window.share[at] = std::exp(-4.0 * std::numbers::ln2 * u * u);
  }
  return window;
}

/// Adds weight * derivative of the fit at this height.
void add_derivatives(std::span<const double> z_um, double height_um, double weight, double width_um,
                     std::vector<double>& sums) {
  const auto nearer = [height_um](double a, double b) { return std::abs(a - height_um) < std::abs(b - height_um); };
  const auto centre = static_cast<std::size_t>(std::min_element(z_um.begin(), z_um.end(), nearer) - z_um.begin());
  const auto window = window_about(z_um, centre, height_um, width_um);
  if (!window) return;
  const double move_um = kMove * std::abs(z_um[centre + 1] - z_um[centre]);
  for (std::size_t i = 0; i < window->z_um.size(); ++i) {
    if (!window->exists[i]) continue;
    Window lower = *window;
    Window higher = *window;
    lower.z_um[i] -= move_um;
    higher.z_um[i] += move_um;
    const auto below = lower.fitted_um();
    const auto above = higher.fitted_um();
    if (below && above) sums[centre + i - kReach] += weight * (*above - *below) / (2.0 * move_um);
  }
}

}  // namespace

std::vector<double> slice_sensitivities(std::span<const double> sample_z_um, double curve_width_um,
                                        std::span<const WeightedHeight> heights) {
  assert(sample_z_um.size() >= 3 && curve_width_um > 0.0);
  const double lowest_um = std::min(sample_z_um.front(), sample_z_um.back());
  const double range_um = std::abs(sample_z_um.back() - sample_z_um.front());
  const std::size_t bins = (sample_z_um.size() - 1) * kPartsOfAStep;
  const double bin_um = range_um / static_cast<double>(bins);
  std::vector<double> weights(bins, 0.0);
  for (const WeightedHeight& point : heights) {
    const double place = (point.height_um - lowest_um) / bin_um;
    if (!(place >= 0.0 && place < static_cast<double>(bins))) continue;
    const auto bin = static_cast<std::size_t>(place);  // of the samples' mean step, which uneven ones make no worse
    weights[bin] += point.weight;
  }
  std::vector<double> sums(sample_z_um.size(), 0.0);
  for (std::size_t bin = 0; bin < bins; ++bin) {
    if (weights[bin] == 0.0) continue;
    const double height_um = lowest_um + (static_cast<double>(bin) + 0.5) * bin_um;
    add_derivatives(sample_z_um, height_um, weights[bin], curve_width_um, sums);
  }
  return sums;
}

}  // namespace fvd
