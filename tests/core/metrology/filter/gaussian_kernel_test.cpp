#include "core/metrology/filter/gaussian_kernel.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace fvd::metrology {
namespace {

TEST(GaussianKernel, PassesHalfOfAWaveOfOneNestingIndexByEveryMethod) {
  for (const FilterMethod method :
       {FilterMethod::kGaussian, FilterMethod::kGaussianRegression1, FilterMethod::kGaussianRegression2}) {
    EXPECT_NEAR(filter_transmission(method, 1.0), 0.5, 1e-12);
    EXPECT_NEAR(filter_transmission(method, 0.0), 1.0, 1e-15);
  }
}

TEST(GaussianKernel, HasTheTransmissionOfTheStandard) {
  EXPECT_NEAR(filter_transmission(FilterMethod::kGaussian, 2.0), 0.0625, 1e-12);
  EXPECT_NEAR(filter_transmission(FilterMethod::kGaussian, 0.5), 0.8408964, 5e-8);
  EXPECT_NEAR(filter_transmission(FilterMethod::kGaussianRegression2, 2.0),
              (1.0 + 4.0 * 1.67834699) * std::exp(-4.0 * 1.67834699), 1e-10);
}

TEST(GaussianKernel, ReachesSoFarThatNothingIsMissing) {
  const SampledGaussian kernel = sample_gaussian(FilterMethod::kGaussian, 100.0);

  EXPECT_GE(kernel.reach_px(), 100);
  EXPECT_DOUBLE_EQ(kernel.weights[0], 1.0);
  EXPECT_NEAR(kernel.weights[50],
              std::exp2(-0.25 * std::numbers::pi * std::numbers::pi / (std::numbers::ln2 * std::numbers::ln2)), 1e-12);
  EXPECT_NEAR(kernel.sum() / (100.0 * std::sqrt(std::numbers::ln2 / std::numbers::pi)), 1.0, 1e-7);
}

TEST(FilterNames, AreReadBack) {
  EXPECT_EQ(filter_method_from_name("gaussian_regression_2"), FilterMethod::kGaussianRegression2);
  EXPECT_EQ(filter_method_name(FilterMethod::kGaussian), "gaussian");
  EXPECT_EQ(filter_side_from_name("L"), FilterSide::kL);
  EXPECT_EQ(filter_side_name(FilterSide::kS), "S");
  EXPECT_FALSE(filter_method_from_name("spline"));
  EXPECT_FALSE(filter_side_from_name("s"));
}

}  // namespace
}  // namespace fvd::metrology
