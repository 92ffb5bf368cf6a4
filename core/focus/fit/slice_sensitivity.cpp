#include "core/focus/fit/slice_sensitivity.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <functional>
#include <numbers>
#include <optional>

#include "core/focus/fit/fit_reference.hpp"

namespace fvd {

namespace {

constexpr int kPartsOfAStep = 32;
constexpr int kReach = 2;         ///< as in the class
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

}  // namespace

SliceSensitivity::SliceSensitivity(std::span<const double> sample_z_um, double curve_width_um)
    : z_um_(sample_z_um.begin(), sample_z_um.end()),
      width_um_(curve_width_um),
      lowest_um_(std::min(sample_z_um.front(), sample_z_um.back())),
      derivatives_((sample_z_um.size() - 1) * kPartsOfAStep) {
  assert(sample_z_um.size() >= 3 && curve_width_um > 0.0);
  bin_um_ = std::abs(sample_z_um.back() - sample_z_um.front()) / static_cast<double>(bins());
}

SliceSensitivity::Derivatives SliceSensitivity::derivatives_at(double height_um) const {
  Derivatives found;
  found.known = true;
  const auto nearer = [height_um](double a, double b) { return std::abs(a - height_um) < std::abs(b - height_um); };
  found.centre = static_cast<std::size_t>(std::min_element(z_um_.begin(), z_um_.end(), nearer) - z_um_.begin());
  const auto window = window_about(z_um_, found.centre, height_um, width_um_);
  if (!window) return found;
  const double move_um = kMove * std::abs(z_um_[found.centre + 1] - z_um_[found.centre]);
  for (std::size_t i = 0; i < window->z_um.size(); ++i) {
    if (!window->exists[i]) continue;
    Window lower = *window;
    Window higher = *window;
    lower.z_um[i] -= move_um;
    higher.z_um[i] += move_um;
    const auto below = lower.fitted_um();
    const auto above = higher.fitted_um();
    if (below && above) found.at[i] = (*above - *below) / (2.0 * move_um);
  }
  return found;
}

std::vector<double> SliceSensitivity::of(std::span<const double> weights, WorkerPool* pool) {
  assert(weights.size() == bins());
  make_known(weights, pool);
  std::vector<double> sums(z_um_.size(), 0.0);
  for (std::size_t bin = 0; bin < bins(); ++bin) {
    if (weights[bin] == 0.0) continue;
    const Derivatives& here = derivatives_[bin];
    for (std::size_t i = 0; i < here.at.size(); ++i) {
      if (here.at[i] != 0.0) sums[here.centre + i - kReach] += weights[bin] * here.at[i];
    }
  }
  return sums;
}

void SliceSensitivity::make_known(std::span<const double> weights, WorkerPool* pool) {
  MutexLock lock(making_);
  std::vector<std::size_t> wanted;
  for (std::size_t bin = 0; bin < bins(); ++bin) {
    if (weights[bin] != 0.0 && !derivatives_[bin].known) wanted.push_back(bin);
  }
  const auto make = [&](int index) {
    const std::size_t bin = wanted[static_cast<std::size_t>(index)];
    derivatives_[bin] = derivatives_at(lowest_um_ + (static_cast<double>(bin) + 0.5) * bin_um_);
  };
  if (pool != nullptr) {
    pool->run(static_cast<int>(wanted.size()), std::ref(make));
  } else {
    for (std::size_t index = 0; index < wanted.size(); ++index) make(static_cast<int>(index));
  }
}

std::vector<double> slice_sensitivities(std::span<const double> sample_z_um, double curve_width_um,
                                        std::span<const WeightedHeight> heights) {
  SliceSensitivity sensitivity(sample_z_um, curve_width_um);
  std::vector<double> weights(sensitivity.bins(), 0.0);
  for (const WeightedHeight& point : heights) {
    const std::size_t bin = sensitivity.bin_of(point.height_um);
    if (bin < weights.size()) weights[bin] += point.weight;
  }
  return sensitivity.of(weights, nullptr);
}

}  // namespace fvd
