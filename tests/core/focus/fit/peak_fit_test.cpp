#include "core/focus/fit/peak_fit.hpp"

#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <random>

#include "gtest/gtest.h"

namespace fvd {
namespace {

PeakTriple sample(const std::function<double(double)>& curve, double z1, double z2, double z3) {
  return {z1, z2, z3, curve(z1), curve(z2), curve(z3)};
}

constexpr double kSmallest = 0.5;

/// All but the one with a fit of its own.
constexpr std::array kTripleMethods{PeakMethod::kNearest, PeakMethod::kParabola, PeakMethod::kLogParabola,
                                    PeakMethod::kInverseRoot};

std::optional<double> fit_peak_um(PeakMethod method, const PeakTriple& triple) {
  const auto position = fit_peak(method, triple, kSmallest);
  return position ? std::optional(position->z_um) : std::nullopt;
}

double parabola(double z) { return 1e9 - 1e6 * (z - 2.3) * (z - 2.3); }
double heavy_tailed(double z) { return 4e9 / std::pow(1.0 + (z - 2.3) * (z - 2.3) / 400.0, 2); }
double gaussian(double z) { return 4e9 * std::exp(-0.5 * (z - 2.3) * (z - 2.3) / (12.0 * 12.0)); }

TEST(PeakFit, ParabolaIsExactOnAParabolaAtUnevenHeights) {
  const auto z = fit_peak_um(PeakMethod::kParabola, sample(parabola, -9.0, 1.0, 14.0));
  ASSERT_TRUE(z);
  EXPECT_NEAR(*z, 2.3, 1e-6);
}

TEST(PeakFit, LogParabolaIsExactOnAGaussianAtUnevenHeights) {
  const auto z = fit_peak_um(PeakMethod::kLogParabola, sample(gaussian, -9.0, 1.0, 14.0));
  ASSERT_TRUE(z);
  EXPECT_NEAR(*z, 2.3, 1e-6);
}

TEST(PeakFit, InverseRootIsExactOnAHeavyTailedPeakAtUnevenHeights) {
  const auto z = fit_peak_um(PeakMethod::kInverseRoot, sample(heavy_tailed, -9.0, 1.0, 14.0));
  ASSERT_TRUE(z);
  EXPECT_NEAR(*z, 2.3, 1e-6);
}

TEST(PeakFit, DoesNotDependOnTheDirectionOfTheScan) {
  for (const PeakMethod method : kTripleMethods) {
    const auto up = fit_peak_um(method, sample(gaussian, -9.0, 1.0, 14.0));
    const auto down = fit_peak_um(method, sample(gaussian, 14.0, 1.0, -9.0));
    ASSERT_TRUE(up && down);
    EXPECT_NEAR(*up, *down, 1e-9);
  }
}

TEST(PeakFit, NearestIsTheHeightOfTheSharpestSlice) {
  EXPECT_EQ(fit_peak_um(PeakMethod::kNearest, sample(gaussian, -9.0, 1.0, 14.0)), 1.0);
}

TEST(PeakFit, StaysBetweenTheNeighbours) {
  for (const PeakMethod method : kTripleMethods) {
    for (const PeakTriple& triple : {PeakTriple{0, 1, 9, 999, 1000, 1000}, PeakTriple{0, 8, 9, 1000, 1000, 0},
                                     PeakTriple{0, 1, 2, 0, 1, 0}, PeakTriple{0, 1, 2, 4000000000U, 4000000001U, 1}}) {
      const auto z = fit_peak_um(method, triple);
      ASSERT_TRUE(z);
      EXPECT_GT(*z, triple.z_left_um);
      EXPECT_LT(*z, triple.z_right_um);
    }
  }
}

TEST(PeakFit, PredictsWhatNoiseDoesToThePosition) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  for (const PeakMethod method : {PeakMethod::kParabola, PeakMethod::kLogParabola, PeakMethod::kInverseRoot}) {
    PeakTriple triple = sample(gaussian, -9.0, 1.0, 14.0);
    triple.noise = 0.005 * triple.peak;
    const auto exact = fit_peak(method, triple, kSmallest);
    ASSERT_TRUE(exact);
    double squares = 0.0;
    constexpr int kDraws = 20000;
    for (int i = 0; i < kDraws; ++i) {
      PeakTriple noisy = triple;
      for (double* value : {&noisy.left, &noisy.peak, &noisy.right}) *value += triple.noise * normal(random);
      squares += std::pow(*fit_peak_um(method, noisy) - exact->z_um, 2);
    }
    EXPECT_NEAR(std::sqrt(squares / kDraws) / exact->sigma_um, 1.0, 0.05) << peak_method_name(method);
  }
}

TEST(PeakFit, RefusesATripleThatDoesNotEncloseAMaximum) {
  EXPECT_FALSE(fit_peak_um(PeakMethod::kParabola, {0, 1, 2, 5, 5, 5}));
  EXPECT_FALSE(fit_peak_um(PeakMethod::kParabola, {0, 1, 2, 6, 5, 4}));
  EXPECT_FALSE(fit_peak_um(PeakMethod::kNearest, {0, 1, 2, 4, 5, 6}));
}

TEST(PeakFit, RefusesHeightsThatDoNotRunOneWay) {
  EXPECT_FALSE(fit_peak_um(PeakMethod::kParabola, {0, 1, 0.5, 4, 9, 4}));
  EXPECT_FALSE(fit_peak_um(PeakMethod::kNearest, {1, 1, 2, 4, 9, 4}));
}

}  // namespace
}  // namespace fvd
