#include "core/metrology/filter/profile_filter.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "core/base/error.hpp"
#include "core/metrology/filter/border_error.hpp"
#include "core/metrology/filter/check_nesting.hpp"
#include "core/metrology/filter/gaussian_kernel.hpp"
#include "core/metrology/filter/local_polynomial.hpp"
#include "core/metrology/filter/robust_rounds.hpp"

namespace fvd::metrology {
namespace {

constexpr double kHole = std::numeric_limits<double>::quiet_NaN();

/// Weights times the distance, in deviations, to the powers 0 to 4; at the distances 0, 1, ... points; sum 1.
struct PoweredKernel {
  std::array<std::vector<double>, 5> powers;
  [[nodiscard]] int reach() const { return static_cast<int>(powers[0].size()) - 1; }
};

PoweredKernel powered_kernel(FilterMethod method, double nesting_px) {
  const SampledGaussian kernel = sample_gaussian(method, nesting_px);
  const double sum = kernel.sum();
  PoweredKernel result;
  for (std::size_t d = 0; d < kernel.weights.size(); ++d) {
    const double distance = static_cast<double>(d) / kernel.deviation_px;
    double value = kernel.weights[d] / sum;
    for (std::vector<double>& power : result.powers) {
      power.push_back(value);
      value *= distance;
    }
  }
  return result;
}

/// Sums over the neighbours of one point: weight and weighted height, times the distance to each power.
struct PointMoments {
  std::array<double, 5> weight{};
  std::array<double, 3> height{};
};

template <std::size_t Terms>
PointMoments moments_at(const PoweredKernel& kernel, std::span<const double> z_um, std::span<const double> weights,
                        int at) {
  PointMoments moments;
  const int last = static_cast<int>(z_um.size()) - 1;
  for (int i = std::max(0, at - kernel.reach()); i <= std::min(last, at + kernel.reach()); ++i) {
    const auto place = static_cast<std::size_t>(i);
    const auto distance = static_cast<std::size_t>(std::abs(i - at));
    const double weight = weights[place];
    const double weighted_height = weight * z_um[place];
    const double sign = i < at ? -1.0 : 1.0;
    for (std::size_t k = 0; k < 2 * Terms - 1; ++k) {
      const double factor = k % 2 == 0 ? kernel.powers[k][distance] : sign * kernel.powers[k][distance];
      moments.weight[k] += weight * factor;
      if (k < Terms) moments.height[k] += weighted_height * factor;
    }
  }
  return moments;
}

template <std::size_t Terms>
double value_at(const PointMoments& sums) {
  LocalMoments<Terms> moments;
  // The constant is the last: coefficient i has the power i + 1, the last the power 0.
  const auto power = [](std::size_t i) { return i + 1 == Terms ? 0 : i + 1; };
  for (std::size_t i = 0; i < Terms; ++i) {
    for (std::size_t j = 0; j <= i; ++j) moments.matrix[i][j] = sums.weight[power(i) + power(j)];
    moments.right[i] = sums.height[power(i)];
  }
  return constant_term(moments).value_or(kHole);
}

/// What the fit is where every point within reach counts alike: one weight for each distance.
template <std::size_t Terms>
struct WholeKernel {
  std::vector<double> weights;  ///< at the distances 0, 1, ...; empty where the points do not determine the fit
  double share = 0.0;           ///< sum of the kernel

  explicit WholeKernel(const PoweredKernel& kernel) {
    const auto reach = static_cast<std::size_t>(kernel.reach());
    const std::vector<double> ones(2 * reach + 1, 1.0);
    const PointMoments sums = moments_at<Terms>(kernel, ones, ones, kernel.reach());
    share = sums.weight[0];
    if (share < kMinRegressionWeightShare) return;
    for (std::size_t distance = 0; distance <= reach; ++distance) {
      // A height of 1 in two mirrored places: odd powers are 0.
      PointMoments one = sums;
      for (std::size_t k = 0; k < Terms; ++k) one.height[k] = k % 2 == 0 ? kernel.powers[k][distance] : 0.0;
      weights.push_back(value_at<Terms>(one));
    }
    if (std::isnan(weights.front())) weights.clear();
  }
};

constexpr std::size_t kLanes = 8;

/// smooth_um[i] for i in [first, end), all of whose neighbours within reach count.
void average(std::span<const double> kernel, std::span<const double> z_um, std::size_t first, std::size_t end,
             std::span<double> smooth_um) {
  std::size_t i = first;
  for (; i + kLanes <= end; i += kLanes) {
    std::array<double, kLanes> sums{};
    const double* at = z_um.data() + i;
    for (std::size_t lane = 0; lane < kLanes; ++lane) sums[lane] = kernel[0] * at[lane];
    for (std::size_t distance = 1; distance < kernel.size(); ++distance) {
      const double* before = at - distance;
      const double* behind = at + distance;
      for (std::size_t lane = 0; lane < kLanes; ++lane) sums[lane] += kernel[distance] * (before[lane] + behind[lane]);
    }
    std::copy(sums.begin(), sums.end(), smooth_um.data() + i);
  }
  for (; i < end; ++i) {
    double sum = kernel[0] * z_um[i];
    for (std::size_t distance = 1; distance < kernel.size(); ++distance) {
      sum += kernel[distance] * (z_um[i - distance] + z_um[i + distance]);
    }
    smooth_um[i] = sum;
  }
}

/// Runs of points that count alike, further than the reach from their ends, take one weighted sum a point; the others
/// take all moments.
template <std::size_t Terms>
void smooth_profile(const PoweredKernel& kernel, std::span<const double> z_um, std::span<const double> weights,
                    std::span<double> smooth_um, std::span<double> share) {
  const auto reach = static_cast<std::size_t>(kernel.reach());
  const auto point_by_point = [&](std::size_t first, std::size_t end) {
    for (std::size_t i = first; i < end; ++i) {
      const PointMoments sums = moments_at<Terms>(kernel, z_um, weights, static_cast<int>(i));
      share[i] = sums.weight[0];
      smooth_um[i] = share[i] >= kMinRegressionWeightShare ? value_at<Terms>(sums) : kHole;
    }
  };
  std::optional<WholeKernel<Terms>> whole;
  std::size_t done = 0;
  for (std::size_t from = 0; from < weights.size();) {
    std::size_t to = from;
    while (to < weights.size() && weights[to] == 1.0) ++to;
    if (to - from > 2 * reach) {
      if (!whole) whole.emplace(kernel);
      if (whole->weights.empty()) break;
      point_by_point(done, from + reach);
      average(whole->weights, z_um, from + reach, to - reach, smooth_um);
      std::fill(share.begin() + static_cast<std::ptrdiff_t>(from + reach),
                share.begin() + static_cast<std::ptrdiff_t>(to - reach), whole->share);
      done = to - reach;
    }
    from = to + 1;
  }
  point_by_point(done, z_um.size());
}

void smooth(FilterMethod method, const PoweredKernel& kernel, std::span<const double> z_um,
            std::span<const double> weights, std::span<double> smooth_um, std::span<double> share) {
  switch (method) {
    case FilterMethod::kGaussian:
      smooth_profile<1>(kernel, z_um, weights, smooth_um, share);
      return;
    case FilterMethod::kGaussianRegression1:
      smooth_profile<2>(kernel, z_um, weights, smooth_um, share);
      return;
    case FilterMethod::kGaussianRegression2:
      smooth_profile<3>(kernel, z_um, weights, smooth_um, share);
      return;
  }
}

/// z_um: of the profile; smooth_um becomes the side that was asked for. Returns the smallest share beside a given
/// point.
double write_side(std::span<const double> z_um, double pitch_um, const FilterSettings& settings,
                  std::span<const double> share, std::span<double> smooth_um, FilterReport& report) {
  const double least = settings.method == FilterMethod::kGaussian ? kMinWeightShare : kMinRegressionWeightShare;
  const double length_um = static_cast<double>(z_um.size()) * pitch_um;
  double smallest = 1.0;
  for (std::size_t i = 0; i < z_um.size(); ++i) {
    const double x = (static_cast<double>(i) + 0.5) * pitch_um;
    const double value = settings.side == FilterSide::kS ? smooth_um[i] : z_um[i] - smooth_um[i];
    const bool valid = !std::isnan(z_um[i]);
    // Rounding must not decide where exactly half is valid.
    const bool given = valid && share[i] >= least - 1e-9 && !std::isnan(value) && x >= report.margin_um &&
                       x <= length_um - report.margin_um;
    if (valid) ++report.points_in;
    if (valid && !given) ++report.points_lost;
    if (given) smallest = std::min(smallest, share[i]);
    smooth_um[i] = given ? value : kHole;
  }
  return smallest;
}

void judge_border(std::span<const double> z_um, double pitch_um, const FilterSettings& settings, double smallest_share,
                  FilterReport& report) {
  auto row = Plane<double>::unset(static_cast<int>(z_um.size()), 1);
  std::copy(z_um.begin(), z_um.end(), row.row(0));
  report.border_error_um =
      border_error_um(settings.method, settings.nesting_um, general_shape(row, pitch_um, pitch_um), smallest_share);
  report.noise_floor_um = settings.noise_floor_um;
  report.border_error_above_noise = report.noise_floor_um && report.border_error_um > *report.noise_floor_um;
}

}  // namespace

FilteredProfile filter_profile(std::span<const double> z_um, double pitch_um, const FilterSettings& settings) {
  if (z_um.empty()) throw Error(ErrorCode::kBadInput, "a filter needs a profile with at least one point");
  FilteredProfile result;
  result.report.nesting_px_x = checked_nesting_px(settings.nesting_um, pitch_um, "");
  const bool takes_margin =
      settings.side == FilterSide::kL && settings.method == FilterMethod::kGaussian && !settings.keep_margin;
  result.report.margin_um = takes_margin ? 0.5 * settings.nesting_um : 0.0;

  std::vector<double> weights(z_um.size(), 0.0);
  std::vector<double> heights(z_um.size(), 0.0);  // 0 in holes
  for (std::size_t i = 0; i < z_um.size(); ++i) {
    if (std::isnan(z_um[i])) continue;
    weights[i] = 1.0;
    heights[i] = z_um[i];
  }
  result.z_um.resize(z_um.size());
  std::vector<double> share(z_um.size());
  std::vector<double> share_of_points;
  const PoweredKernel kernel = powered_kernel(settings.method, result.report.nesting_px_x);
  const auto fit = [&] {
    smooth(settings.method, kernel, heights, weights, result.z_um, share);
    if (share_of_points.empty()) share_of_points = share;  // the first fit's weights are the points
  };
  if (settings.robust) {
    const RobustRounds rounds = fit_robustly(z_um, weights, result.z_um, fit);
    result.report.rounds = rounds.rounds;
    result.report.converged = rounds.converged;
    result.report.cut_um = rounds.cut_um;
  } else {
    fit();
  }
  const double smallest = write_side(z_um, pitch_um, settings, share_of_points, result.z_um, result.report);
  judge_border(z_um, pitch_um, settings, smallest, result.report);
  return result;
}

}  // namespace fvd::metrology
