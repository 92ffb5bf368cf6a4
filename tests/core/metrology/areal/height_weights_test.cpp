#include "core/metrology/areal/height_weights.hpp"

#include <array>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "core/metrology/areal/evaluate_areal.hpp"

namespace fvd::metrology {
namespace {

HeightField rough_field() {
  HeightField field;
  field.z_um = Plane<double>(9, 7);
  for (int y = 0; y < 7; ++y) {
    for (int x = 0; x < 9; ++x) field.z_um.at(x, y) = std::sin(1.7 * x + 0.4 * y * y) + 0.3 * std::cos(2.9 * x * y);
  }
  field.z_um.at(4, 3) = std::numeric_limits<double>::quiet_NaN();
  return field;
}

Region without_first_column() {
  Region region(9, 7, 1);
  for (int y = 0; y < 7; ++y) region.at(0, y) = 0;
  return region;
}

double value_of(const HeightField& field, const Region& region, ArealParameter parameter) {
  const std::array asked{parameter};
  return evaluate_areal(field, region, asked).values.front().value.value();
}

class Derivatives : public ::testing::TestWithParam<ArealParameter> {};

TEST_P(Derivatives, AreThoseOfTheValue) {
  const HeightField field = rough_field();
  const Region region = without_first_column();

  const auto map = height_weights(field, region, GetParam());

  ASSERT_TRUE(map);
  constexpr double kMove_um = 1e-6;
  for (int y = 0; y < 7; ++y) {
    for (int x = 0; x < 9; ++x) {
      if (field.is_hole(x, y)) {
        EXPECT_EQ(map->at(x, y), 0.0);
        continue;
      }
      HeightField higher = field.clone();
      higher.z_um.at(x, y) += kMove_um;
      HeightField lower = field.clone();
      lower.z_um.at(x, y) -= kMove_um;
      const double found =
          (value_of(higher, region, GetParam()) - value_of(lower, region, GetParam())) / (2.0 * kMove_um);
      EXPECT_NEAR(map->at(x, y), found, 1e-7) << x << " " << y;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(OfParametersOfHeights, Derivatives,
                         ::testing::Values(ArealParameter::kSa, ArealParameter::kSq, ArealParameter::kSsk,
                                           ArealParameter::kSku, ArealParameter::kSp, ArealParameter::kSv,
                                           ArealParameter::kSz));

TEST(HeightWeights, AreNotGivenForOtherParametersFlatSurfacesAndEmptyRegions) {
  HeightField flat;
  flat.z_um = Plane<double>(5, 5, 1.0);

  EXPECT_FALSE(height_weights(rough_field(), {}, ArealParameter::kStr));
  EXPECT_FALSE(height_weights(flat, {}, ArealParameter::kSq));
  EXPECT_FALSE(height_weights(flat, Region(5, 5, 0), ArealParameter::kSa));
}

}  // namespace
}  // namespace fvd::metrology
