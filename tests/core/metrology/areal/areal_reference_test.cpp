#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <boost/math/distributions/normal.hpp>
#include <gtest/gtest.h>

#include "areal_surfaces.hpp"
#include "core/metrology/areal/autocorrelation.hpp"

namespace fvd::metrology::testing {
namespace {

using enum ArealParameter;

// A wave that starts at an eighth of its period is cut by borders where its slope squared and its height squared are
// at their means: what borders leave out then has no effect of the first order on slopes and autocorrelation.
constexpr double kEighth = kPi / 4.0;

double wave(double x_um, double phase = 0.0) { return 5.0 * std::sin(2.0 * kPi * x_um / 100.0 + phase); }

void expect_near(const AllValues& values, ArealParameter parameter, double expected, double relative) {
  EXPECT_NEAR(values.number(parameter), expected, relative * std::max(std::abs(expected), 1.0))
      << areal_parameter_info(parameter).name << ' ' << values[parameter].reason;
}

TEST(ArealReference, KnowsTheHeightsOfASinusoid) {
  const AllValues values(make_field(20000, 2, 0.005, 1.0, [](double x, double) { return wave(x); }));

  expect_near(values, kSa, 3.183099, 1e-6);
  expect_near(values, kSq, 3.535534, 1e-6);
  expect_near(values, kSsk, 0.0, 1e-9);
  expect_near(values, kSku, 1.5, 1e-6);
  expect_near(values, kSz, 10.0, 1e-6);
  expect_near(values, kSk, 8.637288, 1e-6);
  EXPECT_TRUE(values[kSk].tie);
  EXPECT_TRUE(values[kSmr2].tie);
  EXPECT_EQ(values.number(kSmr1), 0.0);
  expect_near(values, kSmr2, 75.92982, 1e-6);
  EXPECT_EQ(values.number(kSpk), 0.0);
  expect_near(values, kSvk, 1.799273, 1e-6);
  expect_near(values, kVmp, 0.01628756, 1e-6);
  expect_near(values, kVmc, 4.155270, 1e-6);
  expect_near(values, kVvc, 4.645098, 1e-6);
  expect_near(values, kVvv, 0.1264723, 1e-6);
  expect_near(values, kSxp, 4.984587, 1e-6);
}

TEST(ArealReference, KnowsTheSlopesOfASinusoid) {
  const AllValues values(make_field(4000, 8, 0.025, 1.0, [](double x, double) { return wave(x, kEighth); }));

  expect_near(values, kSdq, 0.2221441, 1e-6);
  expect_near(values, kSdr, 2.423523, 1e-5);
}

TEST(ArealReference, KnowsWhatTwoTrianglesACellGiveForASinusoid) {
  // 1000 columns of 1 um have 999 cells; the cell that is missing to ten whole periods is the steepest.
  const AllValues values(make_field(1000, 10, 1.0, 1.0, [](double x, double) { return wave(x); }));

  EXPECT_NEAR(values.number(kSdr), 2.4203, 5e-5);
}

TEST(ArealReference, RefusesTheAspectRatioOfASinusoidAndKnowsWhereItsAutocorrelationFalls) {
  const HeightField field = make_field(1000, 100, 0.5, 5.0, [](double x, double) { return wave(x, kEighth); });
  const AllValues values(field);

  const Autocorrelation function(cut_region(field, {}), values.evaluation().mean_um);

  EXPECT_NEAR(function.fall_um(0.0, 0.2).value_or(kHole), 21.79529, 5e-6);
  EXPECT_FALSE(function.fall_um(kPi / 2.0, 0.2));
  EXPECT_FALSE(values[kStr].value);
  EXPECT_FALSE(values[kSal].value);
  EXPECT_NE(values[kStr].reason.find("does not fall to 0.2"), std::string::npos) << values[kStr].reason;
  EXPECT_EQ(values[kSal].reason, values[kStr].reason);
}

TEST(ArealReference, KnowsARamp) {
  const AllValues values(make_field(5000, 3, 0.2, 1.0, [](double x, double) { return 0.01 * x; }));

  expect_near(values, kSa, 2.5, 1e-7);
  expect_near(values, kSq, 2.886751, 1e-6);
  expect_near(values, kSku, 1.8, 1e-6);
  expect_near(values, kSk, 10.0, 1e-9);
  expect_near(values, kSpk, 0.0, 1e-9);
  expect_near(values, kSvk, 0.0, 1e-9);
  expect_near(values, kSmr1, 0.0, 1e-9);
  expect_near(values, kSmr2, 100.0, 1e-9);
  expect_near(values, kVmp, 0.05, 1e-6);
  expect_near(values, kVmc, 3.15, 1e-6);
  expect_near(values, kVvc, 3.85, 1e-6);
  expect_near(values, kVvv, 0.2, 1e-6);
  expect_near(values, kSxp, 4.75, 1e-6);
  EXPECT_FALSE(values[kSk].tie);
}

TEST(ArealReference, KnowsATriangle) {
  const auto triangle = [](double x, double) { return x < 500.0 ? 0.02 * x : 20.0 - 0.02 * x; };
  const AllValues values(make_field(4000, 3, 0.25, 1.0, triangle));

  expect_near(values, kSa, 2.5, 1e-7);
  expect_near(values, kSq, 2.886751, 1e-6);
  expect_near(values, kSku, 1.8, 1e-6);
  expect_near(values, kSk, 10.0, 1e-9);
  expect_near(values, kSmr2, 100.0, 1e-9);
  expect_near(values, kVmc, 3.15, 1e-6);
  expect_near(values, kVvv, 0.2, 1e-6);
}

TEST(ArealReference, KnowsTwoLevels) {
  const AllValues half(make_field(100, 20, 1.0, 1.0, [](double x, double) { return x < 50.0 ? 10.0 : 0.0; }));
  const AllValues quarter(make_field(100, 20, 1.0, 1.0, [](double x, double) { return x < 25.0 ? 10.0 : 0.0; }));

  expect_near(half, kSa, 5.0, 1e-12);
  expect_near(half, kSq, 5.0, 1e-12);
  expect_near(half, kSsk, 0.0, 1e-12);
  expect_near(half, kSku, 1.0, 1e-12);
  expect_near(quarter, kSa, 3.75, 1e-12);
  expect_near(quarter, kSq, 4.330127, 2e-7);
  expect_near(quarter, kSsk, 1.154701, 4e-7);
  expect_near(quarter, kSku, 2.333333, 2e-7);
  expect_near(quarter, kSp, 7.5, 1e-12);
  expect_near(quarter, kSv, 2.5, 1e-12);
}

TEST(ArealReference, KnowsNormalHeights) {
  const boost::math::normal_distribution<double> normal;
  std::vector<double> heights_um;
  for (int i = 0; i < 1000000; ++i) heights_um.push_back(boost::math::quantile(normal, (i + 0.5) / 1e6));

  const AllValues values(row_of(heights_um));

  expect_near(values, kSa, 0.7978846, 1e-6);
  expect_near(values, kSku, 3.0, 1e-4);  // the quantiles have no tails
  expect_near(values, kSk, 2.622003, 1e-6);
  expect_near(values, kSpk, 0.9369847, 2e-6);
  expect_near(values, kSmr1, 9.492867, 1e-6);
  expect_near(values, kVmc, 0.9059157, 1e-6);
}

TEST(ArealReference, KnowsAnEggBox) {
  const auto egg_box = [](double x, double y) { return wave(x, kEighth) * wave(y, kEighth) / 5.0; };
  const AllValues values(make_field(800, 800, 0.125, 0.125, egg_box));

  expect_near(values, kSa, 2.026424, 1e-5);
  expect_near(values, kSq, 2.5, 1e-12);
  expect_near(values, kSku, 2.25, 1e-12);
  expect_near(values, kSdq, 0.2221441, 1e-6);
  expect_near(values, kSdr, 2.430607, 2e-5);
  expect_near(values, kSal, 21.79529, 2e-7);
  expect_near(values, kStr, 0.8746243, 1e-7);
}

TEST(ArealReference, KnowsATiltedPlaneAndALevelOne) {
  const AllValues tilted(make_field(90, 70, 1.5, 0.5, [](double x, double y) { return 0.1 * x + 0.05 * y; }));
  const AllValues level(make_field(90, 70, 1.5, 0.5, [](double, double) { return 3.0; }));

  expect_near(tilted, kSdq, 0.1118034, 1e-6);
  expect_near(tilted, kSdr, 0.6230590, 1e-7);
  for (const ArealParameter parameter : {kSa, kSq, kSp, kSv, kSz, kSdq, kSdr, kSxp, kSk, kSpk, kSvk, kVmp, kVvv}) {
    EXPECT_EQ(level.number(parameter), 0.0) << areal_parameter_info(parameter).name;
  }
  for (const ArealParameter parameter : {kSsk, kSku, kSal, kStr, kStd}) {
    EXPECT_EQ(level[parameter].reason, "the heights do not vary") << areal_parameter_info(parameter).name;
  }
}

}  // namespace
}  // namespace fvd::metrology::testing
