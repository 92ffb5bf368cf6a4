#include "core/metrology/filter/surface_smoother.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <vector>

#include "core/metrology/filter/gaussian_kernel.hpp"
#include "core/metrology/filter/local_polynomial.hpp"
#include "core/metrology/filter/moment_rows.hpp"
#include "core/metrology/filter/separable_sum.hpp"

namespace fvd::metrology {
namespace {

constexpr double kHole = std::numeric_limits<double>::quiet_NaN();

std::vector<double> scaled_to_sum_one(SampledGaussian kernel) {
  const double sum = kernel.sum();
  for (double& weight : kernel.weights) weight /= sum;
  return std::move(kernel.weights);
}

SeparableKernel kernel_of(const SmootherInput& input) {
  // Sums that are added up cost by the reach; transforms cost by the waves that pass.
  const bool is_added_up = input.method == FilterMethod::kGaussian &&
                           kUsualSupport * (input.nesting_px_x + input.nesting_px_y) < kLongReachPx - 2;
  const double support = is_added_up ? kUsualSupport : kWholeSupport;
  SampledGaussian x = sample_gaussian(input.method, input.nesting_px_x, support);
  SampledGaussian y = sample_gaussian(input.method, input.nesting_px_y, support);
  const double unit_x = x.deviation_px;
  const double unit_y = y.deviation_px;
  return {scaled_to_sum_one(std::move(x)), scaled_to_sum_one(std::move(y)), unit_x, unit_y};
}

Plane<double> weighted_heights(const SmootherInput& input) {
  auto result = Plane<double>::unset(input.z_um.width(), input.z_um.height());
  const auto z = input.z_um.pixels();
  const auto w = input.weights.pixels();
  std::transform(z.begin(), z.end(), w.begin(), result.pixels().begin(), [](double a, double b) { return a * b; });
  return result;
}

void smooth_by_mean(const SmootherInput& input, WorkerPool* pool, Plane<double>& smooth_um, Plane<double>& share) {
  const SeparableKernel kernel = kernel_of(input);
  const Plane<double> weights = separable_sum(input.weights, kernel, pool);
  const Plane<double> heights = separable_sum(weighted_heights(input), kernel, pool);
  for (std::size_t i = 0; i < smooth_um.pixels().size(); ++i) {
    const double sum = weights.pixels()[i];
    share.pixels()[i] = sum;
    smooth_um.pixels()[i] = sum >= kMinRegressionWeightShare ? heights.pixels()[i] / sum : kHole;
  }
}

/// Terms of a polynomial, the constant as the last one; products of terms are the moments that a fit needs.
struct Plane2d {
  static constexpr std::size_t kTerms = 3;
  static constexpr std::array<MomentPower, kTerms> kPowers{{{1, 0}, {0, 1}, {0, 0}}};
};
struct Paraboloid2d {
  static constexpr std::size_t kTerms = 6;
  static constexpr std::array<MomentPower, kTerms> kPowers{{{1, 0}, {0, 1}, {2, 0}, {1, 1}, {0, 2}, {0, 0}}};
};

/// Each power once, and where the product of two terms finds its own.
template <typename Form>
struct Products {
  std::vector<MomentPower> powers;
  std::array<std::array<std::size_t, Form::kTerms>, Form::kTerms> place{};

  Products() {
    for (std::size_t i = 0; i < Form::kTerms; ++i) {
      for (std::size_t j = 0; j <= i; ++j) {
        const MomentPower product{Form::kPowers[i].x + Form::kPowers[j].x, Form::kPowers[i].y + Form::kPowers[j].y};
        const auto found = std::find_if(powers.begin(), powers.end(), [&](const MomentPower& power) {
          return power.x == product.x && power.y == product.y;
        });
        place[i][j] = static_cast<std::size_t>(found - powers.begin());
        if (found == powers.end()) powers.push_back(product);
      }
    }
  }
};

/// Rows of sums, one for each power; one for each lane.
using RowSums = std::vector<std::vector<double>>;

template <typename Form>
void solve_row(const Products<Form>& products, const RowSums& of_weights, const RowSums& of_heights,
               std::span<double> smooth) {
  for (std::size_t x = 0; x < smooth.size(); ++x) {
    LocalMoments<Form::kTerms> moments;
    for (std::size_t i = 0; i < Form::kTerms; ++i) {
      for (std::size_t j = 0; j <= i; ++j) moments.matrix[i][j] = of_weights[products.place[i][j]][x];
      moments.right[i] = of_heights[i][x];
    }
    const bool enough = moments.matrix[Form::kTerms - 1][Form::kTerms - 1] >= kMinRegressionWeightShare;
    smooth[x] = enough ? constant_term(moments).value_or(kHole) : kHole;
  }
}

template <typename Form>
void smooth_by_polynomial(const SmootherInput& input, WorkerPool* pool, Plane<double>& smooth_um,
                          Plane<double>& share) {
  const Products<Form> products;
  const auto width = static_cast<std::size_t>(input.z_um.width());
  constexpr int kHighest = Form::kPowers[Form::kTerms - 2].y;
  MomentRows moments(input.z_um.width(), input.z_um.height(), kernel_of(input), 2 * kHighest, 3 * kHighest + 2, pool);
  const Plane<double> heights = weighted_heights(input);
  const auto lanes = static_cast<std::size_t>(moments.lanes());
  std::vector<RowSums> of_weights(lanes, RowSums(products.powers.size(), std::vector<double>(width)));
  std::vector<RowSums> of_heights(lanes, RowSums(Form::kTerms, std::vector<double>(width)));
  const std::size_t constant = products.place[Form::kTerms - 1][Form::kTerms - 1];
  for (int band = 0; band < moments.bands(); ++band) {
    const MomentRows::Band band_weights = moments.load(input.weights, band, 2 * kHighest);
    const MomentRows::Band band_heights = moments.load(heights, band, kHighest);
    moments.each_row(band, [&](int lane, int y) {
      RowSums& weight_sums = of_weights[static_cast<std::size_t>(lane)];
      RowSums& height_sums = of_heights[static_cast<std::size_t>(lane)];
      for (std::size_t k = 0; k < weight_sums.size(); ++k) {
        moments.sum_row(band_weights, y, products.powers[k], lane, weight_sums[k].data());
      }
      for (std::size_t k = 0; k < height_sums.size(); ++k) {
        moments.sum_row(band_heights, y, Form::kPowers[k], lane, height_sums[k].data());
      }
      solve_row<Form>(products, weight_sums, height_sums, {smooth_um.row(y), width});
      std::copy_n(weight_sums[constant].data(), width, share.row(y));
    });
  }
}

}  // namespace

void smooth_surface(const SmootherInput& input, WorkerPool* pool, Plane<double>& smooth_um, Plane<double>& share) {
  switch (input.method) {
    case FilterMethod::kGaussian:
      smooth_by_mean(input, pool, smooth_um, share);
      return;
    case FilterMethod::kGaussianRegression1:
      smooth_by_polynomial<Plane2d>(input, pool, smooth_um, share);
      return;
    case FilterMethod::kGaussianRegression2:
      smooth_by_polynomial<Paraboloid2d>(input, pool, smooth_um, share);
      return;
  }
}

}  // namespace fvd::metrology
