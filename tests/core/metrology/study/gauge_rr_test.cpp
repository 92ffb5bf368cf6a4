#include "core/metrology/study/gauge_rr.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/error.hpp"

namespace fvd::metrology {
namespace {

GaugeRrSettings sized(int parts, int operators, int trials) {
  GaugeRrSettings settings;
  settings.parts = parts;
  settings.operators = operators;
  settings.trials = trials;
  return settings;
}

/// Two trials, `spread` above and below what value(part, operator) says.
template <typename Value>
std::vector<double> two_trials(int parts, int operators, double spread, const Value& value) {
  std::vector<double> values;
  for (int part = 0; part < parts; ++part) {
    for (int person = 0; person < operators; ++person) {
      values.push_back(value(part, person) + spread);
      values.push_back(value(part, person) - spread);
    }
  }
  return values;
}

TEST(GaugeRr, PoolsAnInteractionThatIsNotThere) {
  const std::vector<double> values = two_trials(3, 2, 0.1, [](int part, int person) { return part + 0.2 * person; });
  GaugeRrSettings settings = sized(3, 2, 2);
  settings.tolerance = 2.0;

  const GaugeRr study = gauge_rr(values, settings);

  EXPECT_TRUE(study.interaction_pooled);
  EXPECT_EQ(study.interaction, 0.0);
  EXPECT_NEAR(study.ev, 0.1224745, 5e-8);
  EXPECT_NEAR(study.av, 0.1322876, 5e-8);
  EXPECT_NEAR(study.grr, 0.1802776, 5e-8);
  EXPECT_NEAR(study.pv, std::sqrt(0.99625), 1e-12);  // 0.9981232
  EXPECT_NEAR(study.tv, std::sqrt(1.02875), 1e-12);
  ASSERT_TRUE(study.grr_of_total_percent && study.grr_of_tolerance_percent && study.ndc && study.interaction_p);
  EXPECT_NEAR(*study.grr_of_total_percent, 17.774, 5e-4);
  EXPECT_NEAR(*study.grr_of_tolerance_percent, 100.0 * 6.0 * 0.18027756 / 2.0, 1e-5);
  EXPECT_EQ(*study.ndc, 7);
  EXPECT_EQ(*study.interaction_p, 1.0);
}

TEST(GaugeRr, KeepsAnInteractionThatIsThere) {
  // Parts 0 and 10, operators 0 and 3, interaction 1, trials 0.5 about it. By hand: mean squares 200, 18, 8, 0.5.
  const std::vector<double> values = two_trials(
      2, 2, 0.5, [](int part, int person) { return 10.0 * part + 3.0 * person + (part == person ? 1.0 : -1.0); });

  const GaugeRr study = gauge_rr(values, sized(2, 2, 2));

  EXPECT_FALSE(study.interaction_pooled);
  EXPECT_NEAR(study.ev, std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(study.interaction, std::sqrt((8.0 - 0.5) / 2.0), 1e-12);
  EXPECT_NEAR(study.av, std::sqrt((18.0 - 8.0) / 4.0), 1e-12);
  EXPECT_NEAR(study.pv, std::sqrt((200.0 - 8.0) / 4.0), 1e-12);
  EXPECT_NEAR(study.grr, std::sqrt(0.5 + 3.75 + 2.5), 1e-12);
  EXPECT_NEAR(study.tv, std::sqrt(54.75), 1e-12);
  EXPECT_EQ(study.ndc, 3);  // 1.41 sqrt(48 / 6.75) = 3.76
  // F(1, 4) = 16 is t = 4 with 4 degrees of freedom: p = 1 - s (3 - s^2) / 2 with s = t / sqrt(t^2 + 4).
  const double s = 4.0 / std::sqrt(20.0);
  ASSERT_TRUE(study.interaction_p);
  EXPECT_NEAR(*study.interaction_p, 1.0 - 0.5 * s * (3.0 - s * s), 1e-10);
  EXPECT_FALSE(study.grr_of_tolerance_percent);
}

TEST(GaugeRr, PoolsAboveTheLimitThatIsAskedFor) {
  const std::vector<double> values = two_trials(
      2, 2, 0.5, [](int part, int person) { return 10.0 * part + 3.0 * person + (part == person ? 1.0 : -1.0); });
  GaugeRrSettings settings = sized(2, 2, 2);
  settings.pooling_p = 0.01;  // the interaction's is 0.016

  const GaugeRr study = gauge_rr(values, settings);

  EXPECT_TRUE(study.interaction_pooled);
  EXPECT_NEAR(study.ev, std::sqrt((8.0 + 2.0) / 5.0), 1e-12);
  EXPECT_NEAR(study.av, std::sqrt((18.0 - 2.0) / 4.0), 1e-12);
  EXPECT_NEAR(study.pv, std::sqrt((200.0 - 2.0) / 4.0), 1e-12);
}

TEST(GaugeRr, AgreesWithThePublishedExample) {
  // AIAG MSA, 4th edition, chapter III B: 10 parts, operators A, B, C, 3 trials; by operator and trial.
  const double table[9][10] = {{0.29, -0.56, 1.34, 0.47, -0.80, 0.02, 0.59, -0.31, 2.26, -1.36},
                               {0.41, -0.68, 1.17, 0.50, -0.92, -0.11, 0.75, -0.20, 1.99, -1.25},
                               {0.64, -0.58, 1.27, 0.64, -0.84, -0.21, 0.66, -0.17, 2.01, -1.31},
                               {0.08, -0.47, 1.19, 0.01, -0.56, -0.20, 0.47, -0.63, 1.80, -1.68},
                               {0.25, -1.22, 0.94, 1.03, -1.20, 0.22, 0.55, 0.08, 2.12, -1.62},
                               {0.07, -0.68, 1.34, 0.20, -1.28, 0.06, 0.83, -0.34, 2.19, -1.50},
                               {0.04, -1.38, 0.88, 0.14, -1.46, -0.29, 0.02, -0.46, 1.77, -1.49},
                               {-0.11, -1.13, 1.09, 0.20, -1.07, -0.67, 0.01, -0.56, 1.45, -1.77},
                               {-0.15, -0.96, 0.67, 0.11, -1.45, -0.49, 0.21, -0.49, 1.87, -2.16}};
  std::vector<double> values;
  for (int part = 0; part < 10; ++part) {
    for (int row = 0; row < 9; ++row) values.push_back(table[row][part]);
  }

  const GaugeRr study = gauge_rr(values, sized(10, 3, 3));

  EXPECT_TRUE(study.interaction_pooled);
  EXPECT_NEAR(*study.interaction_p, 0.974, 5e-4);
  EXPECT_NEAR(study.ev, 0.199933, 5e-6);
  EXPECT_NEAR(study.av, 0.226838, 5e-6);
  EXPECT_NEAR(study.grr, 0.302373, 5e-6);
  EXPECT_NEAR(study.pv, 1.042327, 5e-6);
  EXPECT_NEAR(*study.grr_of_total_percent, 27.86, 5e-3);
  EXPECT_EQ(study.ndc, 4);
}

TEST(GaugeRr, OfOneOperatorHasNoReproducibility) {
  const std::vector<double> values = two_trials(3, 1, 0.1, [](int part, int) { return 1.0 * part; });

  const GaugeRr study = gauge_rr(values, sized(3, 1, 2));

  EXPECT_NEAR(study.ev, std::sqrt(0.02), 1e-12);
  EXPECT_NEAR(study.pv, std::sqrt((2.0 - 0.02) / 2.0), 1e-12);
  EXPECT_EQ(study.av, 0.0);
  EXPECT_EQ(study.interaction, 0.0);
  EXPECT_FALSE(study.interaction_pooled);
  EXPECT_FALSE(study.interaction_p);
}

TEST(GaugeRr, HasNoNegativeVariances) {
  // Operators and parts agree in their means more closely than the trials let expect.
  const std::vector<double> values = two_trials(3, 2, 0.5, [](int, int) { return 0.0; });

  const GaugeRr study = gauge_rr(values, sized(3, 2, 2));

  EXPECT_EQ(study.av, 0.0);
  EXPECT_EQ(study.pv, 0.0);
  EXPECT_GT(study.ev, 0.0);
  EXPECT_EQ(study.ndc, 0);
  EXPECT_NEAR(*study.grr_of_total_percent, 100.0, 1e-12);
}

TEST(GaugeRr, OfAPerfectGaugeHasNoCategoriesToCount) {
  const std::vector<double> values =
      two_trials(3, 2, 0.0, [](int part, int person) { return 0.1 + 0.7 * part + 0.0 * person; });

  const GaugeRr study = gauge_rr(values, sized(3, 2, 2));

  EXPECT_EQ(study.grr, 0.0);
  EXPECT_NEAR(study.pv, 0.7, 1e-12);
  EXPECT_FALSE(study.ndc);
  EXPECT_EQ(study.grr_of_total_percent, 0.0);
  EXPECT_TRUE(study.interaction_pooled);
}

TEST(GaugeRr, DoesNotTakeRoundingForAnInteraction) {
  const std::vector<double> values =
      two_trials(7, 3, 0.0, [](int part, int person) { return 100.1 + std::sqrt(2.0 + part) + 0.3 * person; });

  const GaugeRr study = gauge_rr(values, sized(7, 3, 2));

  EXPECT_TRUE(study.interaction_pooled);
  EXPECT_EQ(study.interaction_p, 1.0);
  EXPECT_EQ(study.ev, 0.0);
  EXPECT_NEAR(study.av, 0.3, 1e-10);
}

TEST(GaugeRr, OfEqualValuesHasNoShareOfTheTotal) {
  const GaugeRr study = gauge_rr(std::vector<double>(12, 0.3), sized(3, 2, 2));

  EXPECT_EQ(study.tv, 0.0);
  EXPECT_FALSE(study.grr_of_total_percent);
  EXPECT_FALSE(study.ndc);
}

TEST(GaugeRr, RefusesStudiesThatAreNone) {
  const std::vector<double> values(12, 1.0);
  std::vector<double> holed = values;
  holed[3] = std::numeric_limits<double>::quiet_NaN();
  GaugeRrSettings no_tolerance = sized(3, 2, 2);
  no_tolerance.tolerance = 0.0;

  EXPECT_THROW(static_cast<void>(gauge_rr(values, sized(3, 2, 3))), Error);
  EXPECT_THROW(static_cast<void>(gauge_rr(values, sized(12, 1, 1))), Error);
  EXPECT_THROW(static_cast<void>(gauge_rr(values, sized(1, 6, 2))), Error);
  EXPECT_THROW(static_cast<void>(gauge_rr(values, sized(6, 0, 2))), Error);
  EXPECT_THROW(static_cast<void>(gauge_rr(values, no_tolerance)), Error);
  EXPECT_THROW(static_cast<void>(gauge_rr(holed, sized(3, 2, 2))), Error);
}

}  // namespace
}  // namespace fvd::metrology
