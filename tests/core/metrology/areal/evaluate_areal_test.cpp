#include "core/metrology/areal/evaluate_areal.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "areal_surfaces.hpp"

namespace fvd::metrology::testing {
namespace {

using enum ArealParameter;

/// A surface with a lay, far from z = 0, with holes and a round region.
struct Surface {
  HeightField field;
  Region region;
};

Surface surface_with_lay() {
  std::mt19937 random(31);
  std::normal_distribution<double> normal;
  std::array<std::array<double, 4>, 30> waves{};
  for (auto& wave : waves) {
    for (double& number : wave) number = normal(random);
  }
  Surface surface;
  surface.field = make_field(120, 90, 0.9, 1.2, [&](double x, double y) {
    double z_um = 250.0 + std::sin(0.5 * x + 0.8 * y) + 0.05 * normal(random);
    for (const auto& wave : waves)
      z_um += 0.3 * wave[0] * std::sin(0.2 * wave[1] * x + 0.2 * wave[2] * y + 6.0 * wave[3]);
    return normal(random) > 2.0 ? kHole : z_um;
  });
  surface.region = Region(120, 90);
  for (int y = 0; y < 90; ++y) {
    for (int x = 0; x < 120; ++x) surface.region.at(x, y) = std::hypot(x - 64.0, 1.3 * (y - 41.0)) < 50.0 ? 1 : 0;
  }
  return surface;
}

/// The surface with the point of (x, y) taken from from(x, y).
template <typename From>
Surface moved(const Surface& surface, int width, int height, bool swap_pitches, From&& from) {
  Surface result;
  result.field.z_um = Plane<double>(width, height);
  result.field.pitch_x_um = swap_pitches ? surface.field.pitch_y_um : surface.field.pitch_x_um;
  result.field.pitch_y_um = swap_pitches ? surface.field.pitch_x_um : surface.field.pitch_y_um;
  result.region = Region(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const auto [column, row] = from(x, y);
      result.field.z_um.at(x, y) = surface.field.z_um.at(column, row);
      result.region.at(x, y) = surface.region.at(column, row);
    }
  }
  return result;
}

/// Expects the same values: the same bytes where only heights count, 1e-12 where neighbours count.
void expect_same(const Surface& surface, const Surface& other, double other_direction_deg) {
  const ArealSettings settings{.smr_height_um = 0.4};
  const AllValues expected(surface.field, surface.region, settings);
  const AllValues actual(other.field, other.region, settings);

  EXPECT_EQ(actual.evaluation().points, expected.evaluation().points);
  EXPECT_EQ(actual.evaluation().region_points, expected.evaluation().region_points);
  EXPECT_EQ(actual.evaluation().mean_um, expected.evaluation().mean_um);
  for (const ArealParameterInfo& info : areal_parameters()) {
    const double value = actual.number(info.parameter);
    const double wanted = expected.number(info.parameter);
    const std::set<ArealParameter> by_neighbours = {kSdq, kSdr, kSal, kStr};
    if (info.parameter == kStd) {
      EXPECT_NEAR(value, other_direction_deg, 1e-9);
    } else if (by_neighbours.contains(info.parameter)) {
      EXPECT_NEAR(value, wanted, 1e-12 * wanted) << info.name;
    } else {
      EXPECT_EQ(value, wanted) << info.name;
    }
  }
}

TEST(EvaluateAreal, GivesTheSameValuesForATransposedSurface) {
  const Surface surface = surface_with_lay();
  const double direction_deg = AllValues(surface.field, surface.region).number(kStd);

  const Surface other = moved(surface, 90, 120, true, [](int x, int y) { return std::pair{y, x}; });

  expect_same(surface, other, std::fmod(270.0 - direction_deg, 180.0));
}

TEST(EvaluateAreal, GivesTheSameValuesForAMirroredSurface) {
  const Surface surface = surface_with_lay();
  const double direction_deg = AllValues(surface.field, surface.region).number(kStd);

  expect_same(surface,
              moved(surface, 120, 90, false,
                    [](int x, int y) {
                      return std::pair{119 - x, y};
                    }),
              180.0 - direction_deg);
  expect_same(surface,
              moved(surface, 120, 90, false,
                    [](int x, int y) {
                      return std::pair{x, 89 - y};
                    }),
              180.0 - direction_deg);
}

TEST(EvaluateAreal, GivesTheSameValuesForASurfaceCroppedToItsRegion) {
  const Surface surface = surface_with_lay();
  const double direction_deg = AllValues(surface.field, surface.region).number(kStd);

  const Surface other = moved(surface, 104, 82, false, [](int x, int y) { return std::pair{x + 12, y + 1}; });

  ASSERT_EQ(surface.region.at(11, 41), 0);
  expect_same(surface, other, direction_deg);
}

TEST(EvaluateAreal, LooksAtNothingOutsideTheRegion) {
  const Surface surface = surface_with_lay();
  Surface other = moved(surface, 120, 90, false, [](int x, int y) { return std::pair{x, y}; });
  for (int y = 0; y < 90; ++y) {
    for (int x = 0; x < 120; ++x) {
      if (!is_inside(other.region, x, y)) other.field.z_um.at(x, y) = x % 2 == 0 ? kHole : 1e6;
    }
  }

  expect_same(surface, other, AllValues(surface.field, surface.region).number(kStd));
}

TEST(EvaluateAreal, AgreesWithSumsInLongDouble) {
  const Surface surface = surface_with_lay();
  std::vector<long double> heights;
  long double mean = 0.0L;
  for (std::size_t i = 0; i < surface.field.z_um.pixels().size(); ++i) {
    const double z_um = surface.field.z_um.pixels()[i];
    if (surface.region.pixels()[i] == 0 || std::isnan(z_um)) continue;
    heights.push_back(z_um);
    mean += z_um;
  }
  const auto count = static_cast<long double>(heights.size());
  mean /= count;
  std::array<long double, 5> sums{};
  for (const long double z : heights) {
    sums[1] += std::abs(z - mean) / count;
    for (const std::size_t power : {2U, 3U, 4U}) sums[power] += std::pow(z - mean, static_cast<int>(power)) / count;
  }

  const AllValues values(surface.field, surface.region);

  const long double sq = std::sqrt(sums[2]);
  EXPECT_EQ(values.evaluation().points, heights.size());
  EXPECT_NEAR(values.evaluation().mean_um, static_cast<double>(mean), 1e-12);
  EXPECT_NEAR(values.number(kSa), static_cast<double>(sums[1]), 1e-12);
  EXPECT_NEAR(values.number(kSq), static_cast<double>(sq), 1e-12);
  EXPECT_NEAR(values.number(kSsk), static_cast<double>(sums[3] / (sq * sq * sq)), 1e-11);
  EXPECT_NEAR(values.number(kSku), static_cast<double>(sums[4] / (sq * sq * sq * sq)), 1e-11);
  EXPECT_NEAR(values.number(kSp) + values.number(kSv), values.number(kSz), 1e-12);
}

TEST(EvaluateAreal, CountsPointsAndHoles) {
  HeightField field = make_field(10, 10, 1.0, 1.0, [](double x, double) { return x; });
  field.z_um.at(2, 2) = kHole;
  field.z_um.at(9, 9) = kHole;
  Region region(10, 10);
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 5; ++x) region.at(x, y) = 1;
  }

  const ArealEvaluation part = evaluate_areal(field, region, {});
  const ArealEvaluation whole = evaluate_areal(field, {}, {});

  EXPECT_EQ(part.region_points, 20U);
  EXPECT_EQ(part.points, 19U);
  EXPECT_DOUBLE_EQ(part.valid_fraction(), 0.95);
  EXPECT_DOUBLE_EQ(part.mean_um, 2.5);
  EXPECT_EQ(whole.region_points, 100U);
  EXPECT_EQ(whole.points, 98U);
}

TEST(EvaluateAreal, GivesValuesInTheOrderAskedFor) {
  const HeightField field = make_field(10, 10, 1.0, 1.0, [](double x, double) { return x; });

  const ArealEvaluation evaluation = evaluate_areal(field, {}, std::array{kSz, kSa, kSz});

  ASSERT_EQ(evaluation.values.size(), 3U);
  EXPECT_EQ(evaluation.values[0].value, 9.0);
  EXPECT_EQ(evaluation.values[1].value, 2.5);
  EXPECT_EQ(evaluation.values[2].value, 9.0);
}

TEST(EvaluateAreal, SaysThatARegionHasNoPoint) {
  const HeightField holes = make_field(5, 4, 1.0, 1.0, [](double, double) { return kHole; });
  const HeightField field = make_field(5, 4, 1.0, 1.0, [](double x, double) { return x; });

  const AllValues of_holes(holes);
  const AllValues of_no_region(field, Region(5, 4));
  const AllValues of_no_field{HeightField{}};

  for (const ArealParameterInfo& info : areal_parameters()) {
    for (const AllValues* values : {&of_holes, &of_no_region, &of_no_field}) {
      EXPECT_FALSE((*values)[info.parameter].value) << info.name;
      EXPECT_EQ((*values)[info.parameter].reason, "the region has no valid point") << info.name;
    }
  }
  EXPECT_EQ(of_holes.evaluation().region_points, 20U);
  EXPECT_EQ(of_holes.evaluation().valid_fraction(), 0.0);
  EXPECT_EQ(of_no_region.evaluation().valid_fraction(), 0.0);
}

TEST(EvaluateAreal, EvaluatesFieldsOfOnePixelWidth) {
  const auto height = [](double x, double y) { return std::sin(0.1 * (x + y)); };
  const AllValues row(make_field(2000, 1, 1.0, 1.0, height));
  const AllValues column(make_field(1, 2000, 1.0, 1.0, height));
  const AllValues point(make_field(1, 1, 1.0, 1.0, height));

  for (const ArealParameter parameter : {kSa, kSq, kSku, kSz, kSk, kSvk, kVmc, kSxp}) {
    EXPECT_TRUE(row[parameter].value) << areal_parameter_info(parameter).name;
    EXPECT_EQ(row[parameter].value, column[parameter].value) << areal_parameter_info(parameter).name;
  }
  for (const ArealParameter parameter : {kSdq, kSdr, kSal, kStr, kStd}) {
    for (const AllValues* values : {&row, &column, &point}) {
      EXPECT_FALSE((*values)[parameter].value) << areal_parameter_info(parameter).name;
      EXPECT_FALSE((*values)[parameter].reason.empty()) << areal_parameter_info(parameter).name;
    }
  }
  EXPECT_EQ(point.number(kSq), 0.0);
}

TEST(EvaluateAreal, GivesNoShapeBelowTheNoiseFloor) {
  const HeightField field = make_field(100, 10, 1.0, 1.0, [](double x, double) { return std::sin(x / 5.0); });
  const double sq_um = AllValues(field).number(kSq);

  const AllValues below(field, {}, {.noise_floor_um = sq_um * 1.001});
  const AllValues above(field, {}, {.noise_floor_um = sq_um * 0.999});

  EXPECT_NE(below[kSsk].reason.find("below the noise floor"), std::string::npos) << below[kSsk].reason;
  EXPECT_FALSE(below[kSku].value);
  EXPECT_TRUE(below[kSq].value);
  EXPECT_TRUE(above[kSsk].value);
  EXPECT_TRUE(above[kSku].value);
}

TEST(EvaluateAreal, GivesNoCoreWithFewPoints) {
  const auto height = [](double x, double y) { return std::sin(x) + std::cos(3.0 * y); };
  const AllValues few(make_field(111, 9, 1.0, 1.0, height));
  const AllValues enough(make_field(100, 10, 1.0, 1.0, height));

  for (const ArealParameter parameter : {kSk, kSpk, kSvk, kSmr1, kSmr2}) {
    EXPECT_EQ(few[parameter].reason, "the region has 999 valid points, fewer than 1000");
    EXPECT_TRUE(enough[parameter].value);
  }
  EXPECT_TRUE(few[kVmp].value);
}

TEST(EvaluateAreal, ReadsTheCurveWhereTheSettingsSay) {
  const HeightField field = make_field(1000, 4, 0.01, 1.0, [](double x, double) { return x; });
  const ArealSettings settings{.smr_height_um = 2.5,
                               .smc_ratio_percent = 30.0,
                               .sxp_upper_percent = 10.0,
                               .sxp_lower_percent = 90.0,
                               .volume_peak_percent = 20.0,
                               .volume_pit_percent = 60.0};

  const AllValues values(field, {}, settings);

  EXPECT_NEAR(values.number(kSmr), 25.0, 1e-9);
  EXPECT_NEAR(values.number(kSmc), 2.0, 1e-9);
  EXPECT_NEAR(values.number(kSxp), 8.0, 1e-9);
  EXPECT_NEAR(values.number(kVmp), 0.2, 1e-5);
  EXPECT_NEAR(values.number(kVmc), 1.6, 1e-5);
  EXPECT_NEAR(values.number(kVvc), 2.4, 1e-5);
  EXPECT_NEAR(values.number(kVvv), 0.8, 1e-5);
  EXPECT_EQ(AllValues(field)[kSmr].reason, "the height of Smr is not given");
}

TEST(ArealParameters, AreFoundByTheirNames) {
  std::set<std::string> keys;
  for (const ArealParameterInfo& info : areal_parameters()) {
    EXPECT_EQ(find_areal_parameter(info.name), info.parameter);
    EXPECT_EQ(&areal_parameter_info(info.parameter), &info);
    keys.insert(std::string(info.name) + std::string(info.key_suffix));
  }

  EXPECT_EQ(keys.size(), kArealParameterCount);
  EXPECT_TRUE(keys.contains("Sa_um"));
  EXPECT_TRUE(keys.contains("Ssk"));
  EXPECT_TRUE(keys.contains("Sdr_percent"));
  EXPECT_TRUE(keys.contains("Std_deg"));
  EXPECT_TRUE(keys.contains("Smr2_percent"));
  EXPECT_EQ(find_areal_parameter("Smrk1"), kSmr1);
  EXPECT_EQ(find_areal_parameter("Smrk2"), kSmr2);
  EXPECT_FALSE(find_areal_parameter("sa"));
  EXPECT_FALSE(find_areal_parameter(""));
}

}  // namespace
}  // namespace fvd::metrology::testing
