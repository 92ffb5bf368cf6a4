#include "core/metrology/uncertainty/budget.hpp"

#include <array>
#include <cmath>

#include <gtest/gtest.h>

namespace fvd::metrology {
namespace {

BudgetEntry entry(double u, double dof, double sensitivity = 1.0) {
  BudgetEntry result;
  result.source = "source";
  result.u = u;
  result.dof = dof;
  result.sensitivity = sensitivity;
  return result;
}

TEST(CoverageFactor, IsAQuantileOfStudentsT) {
  // Table G.2 of the GUM with more digits; closed forms for 1 and 2 degrees of freedom.
  EXPECT_NEAR(coverage_factor(1.0, 0.95), std::tan(0.475 * M_PI), 1e-10);
  EXPECT_NEAR(coverage_factor(2.0, 0.95), 0.95 * std::sqrt(2.0 / (1.0 - 0.95 * 0.95)), 1e-12);
  EXPECT_NEAR(coverage_factor(10.0, 0.95), 2.2281389, 1e-7);
  EXPECT_NEAR(coverage_factor(38.0, 0.95), 2.0243942, 1e-7);
  EXPECT_NEAR(coverage_factor(10.0, 0.99), 3.1692727, 1e-7);
}

TEST(CoverageFactor, IsThatOfTheNormalDistributionForInfiniteDegreesOfFreedom) {
  EXPECT_NEAR(coverage_factor(kInfiniteDof, 0.95), 1.959963985, 1e-9);
  EXPECT_NEAR(coverage_factor(kInfiniteDof, 0.9544997361), 2.0, 1e-8);
  EXPECT_NEAR(coverage_factor(1e9, 0.95), coverage_factor(kInfiniteDof, 0.95), 1e-8);
}

TEST(Budget, AddsContributionsInQuadrature) {
  Budget budget;
  budget.entries = {entry(0.03, kInfiniteDof), entry(0.02, kInfiniteDof, -2.0)};

  const std::optional<CombinedUncertainty> all = combined(budget);

  ASSERT_TRUE(all);
  EXPECT_NEAR(all->u, 0.05, 1e-15);
  EXPECT_EQ(all->dof, kInfiniteDof);
  EXPECT_NEAR(all->k, 1.959964, 5e-7);
  EXPECT_NEAR(all->expanded, 0.05 * 1.959963985, 1e-10);
  EXPECT_EQ(all->coverage, 0.95);
}

TEST(Budget, HasTheDegreesOfFreedomOfWelchAndSatterthwaite) {
  // By hand: contributions 0.3, 0.4 and 1.2 give u = 1.3; u^4 = 2.8561, and
  // 0.0081 / 9 + 0.0256 / 4 + 2.0736 / infinity = 0.0073, so that dof = 391.24657...
  Budget budget;
  budget.entries = {entry(0.3, 9.0), entry(0.2, 4.0, 2.0), entry(1.2, kInfiniteDof)};

  const std::optional<CombinedUncertainty> all = combined(budget);

  ASSERT_TRUE(all);
  EXPECT_NEAR(all->u, 1.3, 1e-14);
  EXPECT_NEAR(all->dof, 2.8561 / 0.0073, 1e-8);
  EXPECT_EQ(all->k, coverage_factor(all->dof, 0.95));
  EXPECT_EQ(all->expanded, all->k * all->u);
}

TEST(Budget, OfTheGumsEndGaugeHasSixteenDegreesOfFreedom) {
  // GUM, H.1.6: 25, 9.7, 2.9, 16.6 nm with 18, 25.6, 50, 2 degrees of freedom; the GUM's 32 and 16 are rounded.
  Budget budget;
  budget.entries = {entry(25.0, 18.0), entry(9.7, 25.6), entry(2.9, 50.0), entry(16.6, 2.0)};

  const std::optional<CombinedUncertainty> all = combined(budget, 0.99);

  ASSERT_TRUE(all);
  EXPECT_NEAR(all->u, 31.7, 0.1);
  EXPECT_NEAR(all->dof, 16.7, 0.1);
  EXPECT_NEAR(all->expanded, 92.0, 0.5);
}

TEST(Budget, OfOneEntryKeepsItsDegreesOfFreedomHoweverSmallItIs) {
  Budget budget;
  budget.entries = {entry(1e-120, 7.0), entry(0.0, 3.0)};

  const std::optional<CombinedUncertainty> all = combined(budget);

  ASSERT_TRUE(all);
  EXPECT_DOUBLE_EQ(all->u, 1e-120);
  EXPECT_DOUBLE_EQ(all->dof, 7.0);
}

TEST(Budget, WithoutEntriesIsNotAnUncertaintyOfZero) {
  Budget budget;
  budget.not_evaluated = {"temperature"};

  EXPECT_FALSE(combined(budget));
}

TEST(Budget, OfZerosIsZero) {
  Budget budget;
  budget.entries = {entry(0.0, kInfiniteDof)};

  const std::optional<CombinedUncertainty> all = combined(budget);

  ASSERT_TRUE(all);
  EXPECT_EQ(all->u, 0.0);
  EXPECT_EQ(all->expanded, 0.0);
}

TEST(SliceZ, AddsEachSlicesShareInQuadrature) {
  // Two plateaus, each of them between two slices: the step changes by -0.5, -0.5, 0.5 and 0.5 of their z.
  const std::array sensitivities{-0.5, -0.5, 0.5, 0.5};
  const std::array u_um{0.006, 0.006, 0.008, 0.008};

  const BudgetEntry slices = slice_z_entry(sensitivities, u_um);

  EXPECT_EQ(slices.source, "slice_z");
  EXPECT_EQ(slices.type, UncertaintyType::kB);
  EXPECT_EQ(slices.dof, kInfiniteDof);
  EXPECT_NEAR(slices.contribution(), std::sqrt(2 * 0.003 * 0.003 + 2 * 0.004 * 0.004), 1e-15);
}

TEST(SliceZ, OfASharedShiftIsNotTheSumOfShares) {
  const std::array sensitivities{0.25, 0.25, 0.25, 0.25};
  const std::array u_um{0.01, 0.01, 0.01, 0.01};

  EXPECT_NEAR(slice_z_entry(sensitivities, u_um).contribution(), 0.005, 1e-15);
}

TEST(SliceZ, HasScatterAndResolutionOfThePosition) {
  EXPECT_NEAR(slice_z_uncertainty_um(0.0, 0.02), 0.02 / std::sqrt(12.0), 1e-15);
  EXPECT_NEAR(slice_z_uncertainty_um(0.03, 0.04 * std::sqrt(12.0)), 0.05, 1e-15);
}

}  // namespace
}  // namespace fvd::metrology
