#include "core/metrology/edge/edge_statistics.hpp"

#include <cmath>
#include <random>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/metrology/edge/robust.hpp"

namespace fvd::metrology::edge {
namespace {

TEST(SharedNoise, IsOneForSectionsFarApart) {
  const std::vector<double> along{5.0, 105.0, 205.0};

  EXPECT_DOUBLE_EQ(shared_noise(along, 10.0, 9.0), 1.0);
}

TEST(SharedNoise, IsTheVarianceRatioOfDrawnNoise) {
  // White noise at 1 um averaged over 9 um, then over sections of 10 um; 30 of them side by side.
  std::mt19937_64 generator(5);
  std::normal_distribution<double> normal;
  double of_sections = 0.0;
  double of_means = 0.0;
  for (int draw = 0; draw < 4000; ++draw) {
    std::vector<double> white(308);
    for (double& w : white) w = normal(generator);
    double total = 0.0;
    for (std::size_t section = 0; section < 30; ++section) {
      double sum = 0.0;
      for (std::size_t i = 0; i < 10; ++i) {
        for (std::size_t k = 0; k < 9; ++k) sum += white[section * 10 + i + k];
      }
      of_sections += sum * sum / 30.0;
      total += sum / 30.0;
    }
    of_means += total * total;
  }
  std::vector<double> along;
  for (int i = 0; i < 30; ++i) along.push_back(5.0 + 10.0 * i);

  EXPECT_NEAR(shared_noise(along, 10.0, 9.0), 30.0 * of_means / of_sections, 0.06);
}

TEST(Summary, GivesMedianPercentilesAndTheErrorOfAMedian) {
  const std::vector<double> values{1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0, 10.0, 11.0};
  const std::vector<double> noise(11, 20.0);

  const EdgeValue quiet = summarise(values, {}, 4.0);
  const EdgeValue noisy = summarise(values, noise, 4.0);

  EXPECT_DOUBLE_EQ(*quiet.median, 6.0);
  EXPECT_DOUBLE_EQ(*quiet.p10, 2.0);
  EXPECT_DOUBLE_EQ(*quiet.p90, 10.0);
  EXPECT_NEAR(*quiet.standard_error, 1.2533141 * 1.4826 * 3.0 / std::sqrt(11.0), 1e-6);
  EXPECT_NEAR(*quiet.u, 2.0 * *quiet.standard_error, 1e-12);
  EXPECT_FALSE(quiet.u_noise);
  EXPECT_NEAR(*noisy.u_noise, 2.0 * 1.2533141 * 20.0 / std::sqrt(11.0), 1e-5);
  EXPECT_DOUBLE_EQ(*noisy.u, *noisy.u_noise);
}

TEST(Summary, GivesOneSectionNoSpread) {
  const EdgeValue alone = summarise(std::vector<double>{4.0}, {}, 1.0);
  const EdgeValue known = summarise(std::vector<double>{4.0}, std::vector<double>{0.5}, 1.0);

  EXPECT_FALSE(alone.u);
  EXPECT_EQ(alone.u_reason, EdgeReason::kTooFewSections);
  EXPECT_DOUBLE_EQ(*known.u, 0.5);
}

TEST(Summary, CountsLengthsNearNothingByTheirSquares) {
  // Squares of -4, -1, 0, 1, 4 have a standard deviation of sqrt(34 / 4).
  const std::vector<double> lengths{-2.0, -1.0, 0.0, 1.0, 2.0};

  const EdgeValue value = summarise(lengths, {}, 1.0, true);

  EXPECT_DOUBLE_EQ(*value.median, 0.0);
  EXPECT_NEAR(*value.u, std::sqrt(1.2533141 * std::sqrt(34.0 / 4.0) / std::sqrt(5.0)), 1e-6);
}

TEST(RobustPolynomial, LeavesOutliersAside) {
  std::vector<double> x;
  std::vector<double> y;
  for (int i = 0; i < 60; ++i) {
    x.push_back(i);
    y.push_back(2.0 - 0.1 * i + 0.003 * i * i + (i % 6 == 0 ? 5.0 : 0.0));
  }

  const Polynomial fitted = robust_polynomial(x, y, 2);

  EXPECT_NEAR(fitted(30.0), 2.0 - 3.0 + 2.7, 1e-6);
  EXPECT_NEAR(fitted.slope(30.0), -0.1 + 0.18, 1e-6);
}

TEST(EdgeNames, AreThereForEveryQuantityAndReason) {
  std::set<std::string> names;
  for (std::size_t q = 0; q < kEdgeQuantityCount; ++q) {
    names.emplace(edge_quantity_key(static_cast<EdgeQuantity>(q)));
  }
  for (int reason = 1; reason <= static_cast<int>(EdgeReason::kEdgeLineTooShort); ++reason) {
    names.emplace(edge_reason_text(static_cast<EdgeReason>(reason)));
  }

  EXPECT_EQ(names.size(), kEdgeQuantityCount + 13);
  EXPECT_FALSE(names.contains(""));
  EXPECT_TRUE(edge_reason_text(EdgeReason::kNone).empty());
  EXPECT_EQ(edge_quantity_key(EdgeQuantity::kSGamma), "S_gamma_um");
}

}  // namespace
}  // namespace fvd::metrology::edge
