#include "core/focus/peak_fit.hpp"

#include <cmath>
#include <functional>

#include "gtest/gtest.h"

namespace fvd {
namespace {

PeakTriple sample(const std::function<double(double)>& curve, double z1, double z2, double z3) {
  const auto count = [&](double z) { return static_cast<std::uint32_t>(std::lround(curve(z))); };
  return {z1, z2, z3, count(z1), count(z2), count(z3)};
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
  for (const PeakMethod method : kAllPeakMethods) {
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
  for (const PeakMethod method : kAllPeakMethods) {
    for (const PeakTriple& triple : {PeakTriple{0, 1, 9, 999, 1000, 1000}, PeakTriple{0, 8, 9, 1000, 1000, 0},
                                     PeakTriple{0, 1, 2, 0, 1, 0}, PeakTriple{0, 1, 2, 4000000000U, 4000000001U, 1}}) {
      const auto z = fit_peak_um(method, triple);
      ASSERT_TRUE(z);
      EXPECT_GT(*z, triple.z_left_um);
      EXPECT_LT(*z, triple.z_right_um);
    }
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
