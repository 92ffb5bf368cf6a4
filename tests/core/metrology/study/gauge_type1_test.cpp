#include "core/metrology/study/gauge_type1.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/error.hpp"

namespace fvd::metrology {
namespace {

std::vector<double> two_values(int of_each, double first, double second) {
  std::vector<double> values(static_cast<std::size_t>(of_each), first);
  values.insert(values.end(), static_cast<std::size_t>(of_each), second);
  return values;
}

GaugeType1Settings settings(double reference, double tolerance) {
  GaugeType1Settings result;
  result.reference = reference;
  result.tolerance = tolerance;
  return result;
}

TEST(GaugeType1, IsNotCapableJustBelowWhatIsRequired) {
  const GaugeType1 study = gauge_type1(two_values(25, 50.1, 49.9), settings(50.0, 4.0));

  EXPECT_EQ(study.n, 50);
  EXPECT_NEAR(study.mean, 50.0, 1e-12);
  EXPECT_NEAR(study.sd, 0.1010153, 5e-8);  // 0.1 sqrt(50 / 49)
  ASSERT_TRUE(study.cg && study.cgk && study.t && study.p_value);
  EXPECT_NEAR(*study.cg, 1.319933, 5e-7);
  EXPECT_NEAR(*study.cgk, 1.319933, 5e-7);
  EXPECT_NEAR(*study.t, 0.0, 1e-10);
  EXPECT_NEAR(*study.p_value, 1.0, 1e-10);
  EXPECT_FALSE(study.bias_significant);
  EXPECT_FALSE(study.capable);
  EXPECT_FALSE(study.resolution_percent);
}

TEST(GaugeType1, TakesTheBiasFromCgkAlone) {
  GaugeType1Settings given = settings(49.98, 4.0);
  given.required = 1.2;
  given.resolution = 0.1;
  const GaugeType1 above = gauge_type1(two_values(25, 50.1, 49.9), given);
  given.reference = 50.02;
  const GaugeType1 below = gauge_type1(two_values(25, 50.1, 49.9), given);

  EXPECT_NEAR(above.bias, 0.02, 1e-12);
  EXPECT_NEAR(below.bias, -0.02, 1e-12);
  EXPECT_NEAR(*above.cg, 1.319933, 5e-7);
  EXPECT_NEAR(*above.cgk, 0.38 / (3.0 * 0.1 * std::sqrt(50.0 / 49.0)), 1e-9);  // 1.2539
  EXPECT_NEAR(*below.cgk, *above.cgk, 1e-9);
  EXPECT_NEAR(*below.t, 0.02 * 7.0 / 0.1, 1e-9);  // sqrt(50) / (0.1 sqrt(50 / 49)) = 7 / 0.1
  EXPECT_TRUE(above.capable);
  EXPECT_NEAR(*above.resolution_percent, 2.5, 1e-12);
}

TEST(GaugeType1, NeedsBothFiguresToBeCapable) {
  GaugeType1Settings given = settings(49.98, 4.0);
  given.required = 1.3;  // Cg 1.3199, Cgk 1.2539

  EXPECT_FALSE(gauge_type1(two_values(25, 50.1, 49.9), given).capable);
}

TEST(GaugeType1, TestsTheBiasByStudentsT) {
  // 1 and 3: mean 2, s = sqrt 2, t = |bias|; with one degree of freedom p = 1 - 2 atan(t) / pi.
  const std::array values{1.0, 3.0};

  const GaugeType1 study = gauge_type1(values, settings(-8.0, 1.0));

  EXPECT_NEAR(*study.t, 10.0, 1e-12);
  EXPECT_NEAR(*study.p_value, 1.0 - 2.0 * std::atan(10.0) / M_PI, 1e-12);  // 0.0635
  EXPECT_FALSE(study.bias_significant);
  EXPECT_TRUE(gauge_type1(values, settings(-12.0, 1.0)).bias_significant);  // 0.0454
}

TEST(GaugeType1, HasOtherFactorsOnRequest) {
  GaugeType1Settings given = settings(50.0, 4.0);
  given.tolerance_share = 0.15;
  given.spread_sd = 4.0;

  const GaugeType1 study = gauge_type1(two_values(25, 50.11, 49.91), given);

  EXPECT_NEAR(*study.cg, 0.15 * 4.0 / (4.0 * study.sd), 1e-12);
  EXPECT_NEAR(*study.cgk, (0.3 - 0.01) / (2.0 * study.sd), 1e-9);
}

TEST(GaugeType1, OfEqualValuesHasNoIndices) {
  const std::array values{0.1, 0.1, 0.1};
  const GaugeType1 exact = gauge_type1(values, settings(0.1, 1.0));
  const GaugeType1 near = gauge_type1(values, settings(0.0, 1.0));
  const GaugeType1 far = gauge_type1(values, settings(-0.01, 1.0));

  EXPECT_FALSE(exact.cg || exact.cgk || exact.t || exact.p_value);
  EXPECT_FALSE(exact.bias_significant);
  EXPECT_TRUE(exact.capable);
  EXPECT_TRUE(near.bias_significant);
  EXPECT_TRUE(near.capable);
  EXPECT_FALSE(far.capable);
}

TEST(GaugeType1, RefusesStudiesThatAreNone) {
  const std::array one{1.0};
  const std::array two{1.0, 2.0};
  const std::array holed{1.0, std::numeric_limits<double>::quiet_NaN()};
  GaugeType1Settings no_share = settings(1.0, 1.0);
  no_share.tolerance_share = 0.0;

  EXPECT_THROW(static_cast<void>(gauge_type1(one, settings(1.0, 1.0))), Error);
  EXPECT_THROW(static_cast<void>(gauge_type1(holed, settings(1.0, 1.0))), Error);
  EXPECT_THROW(static_cast<void>(gauge_type1(two, settings(1.0, 0.0))), Error);
  EXPECT_THROW(static_cast<void>(gauge_type1(two, no_share)), Error);
}

}  // namespace
}  // namespace fvd::metrology
