#include "core/metrology/filter/surface_filter.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "core/base/error.hpp"
#include "tests/core/metrology/filter/local_fit_reference.hpp"

namespace fvd::metrology {
namespace {

constexpr double kHole = std::numeric_limits<double>::quiet_NaN();
constexpr FilterMethod kMethods[] = {FilterMethod::kGaussian, FilterMethod::kGaussianRegression1,
                                     FilterMethod::kGaussianRegression2};

/// A disc without points, and one point in eight at random.
void make_holes(HeightField& field) {
  std::mt19937 random(3);
  for (int y = 0; y < field.height(); ++y) {
    for (int x = 0; x < field.width(); ++x) {
      if (std::hypot(x - 12, y - 20) < 7.5 || random() % 8 == 0) field.z_um.at(x, y) = kHole;
    }
  }
}

HeightField rough_field(int width, int height) {
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0.0, 1.0);
  HeightField field{Plane<double>(width, height), {}, 0.5, 0.8, {}};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) field.z_um.at(x, y) = 300.0 + 0.2 * x + 0.01 * x * y + noise(random);
  }
  make_holes(field);
  return field;
}

TEST(SurfaceFilter, IsTheLocalFitOfItsDefinitionBesideHolesAndBorders) {
  double worst = 0.0;
  const HeightField field = rough_field(44, 37);
  for (int order = 0; order < 3; ++order) {
    const FilteredSurface smooth =
        filter_surface(field, {.side = FilterSide::kS, .nesting_um = 6.0, .method = kMethods[order]});
    int compared = 0;
    for (int y = 0; y < 37; y += 3) {
      for (int x = 0; x < 44; ++x) {
        const double value = smooth.surface.z_um.at(x, y);
        if (std::isnan(value)) continue;
        ++compared;
        const double expected =
            local_fit(field.z_um, {}, x, y, order, reference_deviation(order, 12.0), reference_deviation(order, 7.5));
        worst = std::max(worst, std::abs(value - expected));
        EXPECT_NEAR(value, expected, 1e-4) << order << " " << x << " " << y;  // the reference's kernel never ends
      }
    }
    EXPECT_GT(compared, 350);
  }
  RecordProperty("filter_worst_surfaces_with_holes", std::to_string(worst));
}

TEST(SurfaceFilter, KeepsPlanesAndParaboloidsUpToBordersAndHoles) {
  for (const bool bent : {false, true}) {
    HeightField field{Plane<double>(90, 70), {}, 0.5, 0.8, {}};
    for (int y = 0; y < 70; ++y) {
      for (int x = 0; x < 90; ++x) {
        field.z_um.at(x, y) = 100.0 + 0.4 * x - 0.3 * y + (bent ? 0.02 * x * x - 0.01 * x * y + 0.005 * y * y : 0.0);
      }
    }
    make_holes(field);
    const FilterMethod method = bent ? FilterMethod::kGaussianRegression2 : FilterMethod::kGaussianRegression1;

    const FilteredSurface rest = filter_surface(field, {.side = FilterSide::kL, .nesting_um = 20.0, .method = method});
    const FilteredSurface smooth =
        filter_surface(field, {.side = FilterSide::kS, .nesting_um = 20.0, .method = method});

    for (std::size_t i = 0; i < field.z_um.pixels().size(); ++i) {
      const double z = field.z_um.pixels()[i];
      ASSERT_EQ(std::isnan(rest.surface.z_um.pixels()[i]), std::isnan(z));
      if (std::isnan(z)) continue;
      EXPECT_NEAR(rest.surface.z_um.pixels()[i], 0.0, 1e-9);
      EXPECT_NEAR(smooth.surface.z_um.pixels()[i], z, 1e-9);
    }
  }
}

TEST(SurfaceFilter, OfAWholeFieldEqualsThatOfItsBands) {
  // Above the size of one band; the middle of a field far from borders does not see them.
  HeightField field{Plane<double>(1100, 1500), {}, 1.0, 1.0, {}};
  std::mt19937 random(2);
  for (double& z : field.z_um.pixels()) z = static_cast<double>(random() % 1000) * 0.01;
  HeightField part{Plane<double>(200, 200), {}, 1.0, 1.0, {}};
  for (int y = 0; y < 200; ++y) std::copy_n(field.z_um.row(650 + y) + 400, 200, part.z_um.row(y));
  const FilterSettings settings{
      .side = FilterSide::kS, .nesting_um = 30.0, .method = FilterMethod::kGaussianRegression1};

  const FilteredSurface whole = filter_surface(field, settings);
  const FilteredSurface of_part = filter_surface(part, settings);

  for (int y = 40; y < 160; ++y) {
    for (int x = 40; x < 160; ++x) {
      EXPECT_NEAR(whole.surface.z_um.at(400 + x, 650 + y), of_part.surface.z_um.at(x, y), 1e-12);
    }
  }
}

TEST(SurfaceFilter, GivesTheSameTransposedAndMirrored) {
  HeightField field = rough_field(60, 60);
  field.pitch_y_um = field.pitch_x_um;
  HeightField turned = field.clone();
  for (int y = 0; y < 60; ++y) {
    for (int x = 0; x < 60; ++x) turned.z_um.at(59 - y, x) = field.z_um.at(x, y);
  }
  for (const FilterMethod method : kMethods) {
    const FilterSettings settings{.side = FilterSide::kL, .nesting_um = 8.0, .method = method, .robust = true};

    const FilteredSurface rest = filter_surface(field, settings);
    const FilteredSurface of_turned = filter_surface(turned, settings);

    EXPECT_EQ(rest.report.points_lost, of_turned.report.points_lost);
    EXPECT_EQ(rest.report.rounds, of_turned.report.rounds);
    for (int y = 0; y < 60; ++y) {
      for (int x = 0; x < 60; ++x) {
        const double a = rest.surface.z_um.at(x, y);
        const double b = of_turned.surface.z_um.at(59 - y, x);
        ASSERT_EQ(std::isnan(a), std::isnan(b));
        if (!std::isnan(a)) {
          EXPECT_NEAR(a, b, 3e-10);  // 1e-12 of the height of 300 um
        }
      }
    }
  }
}

TEST(SurfaceFilter, GivesTheSameBytesForAnyNumberOfThreads) {
  const HeightField field = rough_field(150, 110);
  WorkerPool pool(3);
  for (const FilterMethod method : kMethods) {
    const FilterSettings settings{.side = FilterSide::kL, .nesting_um = 25.0, .method = method, .robust = true};

    const FilteredSurface alone = filter_surface(field, settings);
    const FilteredSurface shared = filter_surface(field, settings, &pool);

    for (std::size_t i = 0; i < field.z_um.pixels().size(); ++i) {
      const double a = alone.surface.z_um.pixels()[i];
      const double b = shared.surface.z_um.pixels()[i];
      EXPECT_TRUE(a == b || (std::isnan(a) && std::isnan(b)));
    }
  }
}

TEST(SurfaceFilter, GivesNoPointWhereTheMeanSeesUnderHalfOfItsKernel) {
  HeightField field{Plane<double>(80, 80, 5.0), {}, 1.0, 1.0, {}};

  const FilteredSurface smooth = filter_surface(field, {.side = FilterSide::kS, .nesting_um = 30.0});

  EXPECT_FALSE(smooth.surface.is_hole(0, 40));  // a straight border: half, and its own column
  EXPECT_TRUE(smooth.surface.is_hole(0, 0));    // a corner: a quarter
  EXPECT_TRUE(smooth.surface.is_hole(79, 79));
  EXPECT_FALSE(smooth.surface.is_hole(6, 6));
  EXPECT_NEAR(smooth.surface.z_um.at(0, 40), 5.0, 1e-12);
}

TEST(SurfaceFilter, GivesNoPointThatItsNeighboursDoNotDetermine) {
  HeightField field{Plane<double>(60, 60, kHole), {}, 1.0, 1.0, {}};
  for (int x = 0; x < 60; ++x) {
    field.z_um.at(x, 10) = 1.0;                               // a line
    for (int y = 30; y < 60; ++y) field.z_um.at(x, y) = 1.0;  // enough
  }
  field.z_um.at(5, 22) = 1.0;  // a point

  const FilteredSurface smooth =
      filter_surface(field, {.side = FilterSide::kS, .nesting_um = 10.0, .method = FilterMethod::kGaussianRegression1});

  EXPECT_TRUE(smooth.surface.is_hole(30, 10));
  EXPECT_TRUE(smooth.surface.is_hole(5, 22));
  EXPECT_FALSE(smooth.surface.is_hole(0, 59));
  EXPECT_EQ(smooth.report.points_lost, 61u);
}

TEST(SurfaceFilter, RefusesNestingIndicesBelowFivePixelsInEitherDirection) {
  HeightField field{Plane<double>(40, 40, 5.0), {}, 1.0, 2.0, {}};

  EXPECT_NO_THROW((void)filter_surface(field, {.nesting_um = 10.0}));
  EXPECT_THROW((void)filter_surface(field, {.nesting_um = 9.9}), Error);
  field.pitch_x_um = 2.5;
  EXPECT_THROW((void)filter_surface(field, {.nesting_um = 12.0}), Error);
  EXPECT_THROW((void)filter_surface(HeightField{}, {.nesting_um = 12.0}), Error);
}

TEST(SurfaceFilter, LeavesAnEmptySurfaceWithoutPoints) {
  const HeightField field{Plane<double>(40, 40, kHole), {}, 1.0, 1.0, {}};

  const FilteredSurface rest = filter_surface(
      field,
      {.side = FilterSide::kL, .nesting_um = 10.0, .method = FilterMethod::kGaussianRegression2, .robust = true});

  EXPECT_TRUE(rest.surface.is_hole(20, 20));
  EXPECT_EQ(rest.report.points_in, 0u);
  EXPECT_EQ(rest.report.points_lost, 0u);
}

}  // namespace
}  // namespace fvd::metrology
