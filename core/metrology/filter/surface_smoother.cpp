#include "core/metrology/filter/surface_smoother.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <vector>

#include "core/metrology/filter/band_moments.hpp"
#include "core/metrology/filter/gaussian_kernel.hpp"
#include "core/metrology/filter/local_polynomial.hpp"

namespace fvd::metrology {
namespace {

constexpr double kHole = std::numeric_limits<double>::quiet_NaN();
constexpr int kRowsOfALane = 16;

std::vector<double> scaled_to_sum_one(SampledGaussian kernel) {
  const double sum = kernel.sum();
  for (double& weight : kernel.weights) weight /= sum;
  return std::move(kernel.weights);
}

SeparableKernel kernel_of(const SmootherInput& input) {
  SampledGaussian x = sample_gaussian(input.method, input.nesting_px_x);
  SampledGaussian y = sample_gaussian(input.method, input.nesting_px_y);
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

template <typename Form>
void solve_row(const Products<Form>& products, std::span<const double* const> weight_rows,
               std::span<const double* const> height_rows, int width, double* smooth) {
  for (int x = 0; x < width; ++x) {
    LocalMoments<Form::kTerms> moments;
    for (std::size_t i = 0; i < Form::kTerms; ++i) {
      for (std::size_t j = 0; j <= i; ++j) moments.matrix[i][j] = weight_rows[products.place[i][j]][x];
      moments.right[i] = height_rows[i][x];
    }
    const bool enough = moments.matrix[Form::kTerms - 1][Form::kTerms - 1] >= kMinRegressionWeightShare;
    smooth[x] = enough ? constant_term(moments).value_or(kHole) : kHole;
  }
}

std::vector<const double*> rows_of(std::span<const Plane<double>> planes, int y) {
  std::vector<const double*> rows;
  rows.reserve(planes.size());
  for (const Plane<double>& plane : planes) rows.push_back(plane.row(y));
  return rows;
}

template <typename Form>
void smooth_by_polynomial(const SmootherInput& input, WorkerPool* pool, Plane<double>& smooth_um,
                          Plane<double>& share) {
  const Products<Form> products;
  const int width = input.z_um.width();
  const int highest = 2 * (Form::kPowers[Form::kTerms - 2].y);
  BandMoments moments(width, input.z_um.height(), kernel_of(input), highest, pool);
  const Plane<double> heights = weighted_heights(input);
  std::vector<Plane<double>> of_weights(products.powers.size());
  std::array<Plane<double>, Form::kTerms> of_heights;
  const std::size_t constant = products.place[Form::kTerms - 1][Form::kTerms - 1];
  for (int band = 0; band < moments.bands(); ++band) {
    moments.compute(input.weights, band, products.powers, of_weights);
    moments.compute(heights, band, Form::kPowers, of_heights);
    const int first = moments.first_row(band);
    const int rows = moments.first_row(band + 1) - first;
    const auto solve = [&](int lane) {
      for (int y = lane * kRowsOfALane; y < std::min((lane + 1) * kRowsOfALane, rows); ++y) {
        solve_row<Form>(products, rows_of(of_weights, y), rows_of(of_heights, y), width, smooth_um.row(first + y));
        std::copy_n(of_weights[constant].row(y), width, share.row(first + y));
      }
    };
    run_lanes(pool, (rows + kRowsOfALane - 1) / kRowsOfALane, std::ref(solve));
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
