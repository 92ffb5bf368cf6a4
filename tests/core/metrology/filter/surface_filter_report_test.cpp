#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/metrology/filter/surface_filter.hpp"

namespace fvd::metrology {
namespace {

HeightField sloping(double slope_x, double slope_y, double curvature) {
  HeightField field{Plane<double>(200, 160), {}, 1.0, 1.0, {}};
  for (int y = 0; y < 160; ++y) {
    for (int x = 0; x < 200; ++x) {
      const double from_middle = field.x_um(x) - 100.0;
      field.z_um.at(x, y) = slope_x * x + slope_y * y + 0.5 * curvature * from_middle * from_middle;
    }
  }
  return field;
}

TEST(SurfaceFilterReport, TellsWhatASlopeMakesOfABorder) {
  const HeightField field = sloping(0.03, 0.04, 0.0);

  const FilterReport smooth = filter_surface(field, {.side = FilterSide::kS, .nesting_um = 80.0}).report;
  const FilterReport rest = filter_surface(field, {.side = FilterSide::kL, .nesting_um = 80.0}).report;

  EXPECT_NEAR(smooth.border_error_um, 0.1495161 * 80.0 * 0.05, 0.002);
  EXPECT_EQ(rest.margin_um, 40.0);
  EXPECT_NEAR(rest.border_error_um, 0.0, 0.015 * 80.0 * 0.05);  // a margin away hardly anything is left
  EXPECT_GT(rest.border_error_um, 0.0);
}

TEST(SurfaceFilterReport, TellsWhatACurvatureMakesOfABorder) {
  const HeightField field = sloping(0.0, 0.0, 0.002);
  FilterSettings settings{.side = FilterSide::kS, .nesting_um = 60.0};

  const FilterReport mean = filter_surface(field, settings).report;
  settings.method = FilterMethod::kGaussianRegression1;
  const FilteredSurface plane = filter_surface(field, settings);
  settings.method = FilterMethod::kGaussianRegression2;
  const FilterReport paraboloid = filter_surface(field, settings).report;

  EXPECT_NEAR(mean.border_error_um, 0.1495161 * 60.0 * 0.2, 0.01);  // the slope at the border
  EXPECT_NEAR(plane.report.border_error_um, std::abs(plane.surface.z_um.at(0, 80) - field.z_um.at(0, 80)), 0.01);
  EXPECT_GT(plane.report.border_error_um, 0.08);
  EXPECT_EQ(paraboloid.border_error_um, 0.0);
}

TEST(SurfaceFilterReport, ComparesTheBorderWithTheNoise) {
  HeightField field = sloping(0.01, 0.0, 0.0);  // 0.1196 um at nesting 80
  FilterSettings settings{.side = FilterSide::kS, .nesting_um = 80.0};

  EXPECT_FALSE(filter_surface(field, settings).report.noise_floor_um);
  EXPECT_FALSE(filter_surface(field, settings).report.border_error_above_noise);
  settings.noise_floor_um = 0.11;
  EXPECT_TRUE(filter_surface(field, settings).report.border_error_above_noise);
  settings.noise_floor_um = 0.13;
  EXPECT_FALSE(filter_surface(field, settings).report.border_error_above_noise);
  settings.noise_floor_um.reset();
  field.sigma_um = Plane<float>(200, 160, 0.05F);
  EXPECT_TRUE(filter_surface(field, settings).report.border_error_above_noise);
}

TEST(SurfaceFilterReport, CountsTheMarginAsLost) {
  const HeightField field = sloping(0.0, 0.0, 0.0);

  const FilterReport report = filter_surface(field, {.side = FilterSide::kL, .nesting_um = 40.0}).report;

  EXPECT_EQ(report.points_in, 200u * 160u);
  EXPECT_EQ(report.points_lost, 200u * 160u - 160u * 120u);
  EXPECT_EQ(report.rounds, 1);
  EXPECT_TRUE(report.converged);
}

TEST(SmoothNoise, FallsAsTheGaussianAveragesIt) {
  HeightField field{Plane<double>(120, 120, 0.0), Plane<float>(120, 120, 0.6F), 1.0, 1.0, {}};

  const FilteredSurface smooth = filter_surface(field, {.side = FilterSide::kS, .nesting_um = 40.0});
  const FilteredSurface rest = filter_surface(field, {.side = FilterSide::kL, .nesting_um = 40.0});

  const double deviation_px = 40.0 * std::sqrt(std::numbers::ln2 / 2.0) / std::numbers::pi;
  const double expected = 0.6 / (2.0 * std::sqrt(std::numbers::pi) * deviation_px);
  EXPECT_NEAR(smooth.surface.sigma_um.at(60, 60), expected, 1e-4 * expected);
  EXPECT_NEAR(smooth.surface.sigma_um.at(0, 60), expected * std::sqrt(2.0), 0.03 * expected);  // half of the points
  EXPECT_TRUE(std::isnan(smooth.surface.sigma_um.at(0, 0)));
  EXPECT_NEAR(smooth.surface.kernel.width_px(), 2.0 * std::sqrt(std::numbers::pi) * deviation_px, 1e-3);
  EXPECT_NEAR(rest.surface.sigma_um.at(60, 60), 0.6, 1e-6);
  EXPECT_EQ(rest.surface.kernel.weights.size(), 1u);
}

TEST(SmoothNoise, FallsLessWhereAWindowHasAveragedAlready) {
  HeightField field{Plane<double>(120, 120, 0.0), Plane<float>(120, 120, 0.6F), 1.0, 1.0, {}};
  field.kernel.weights.assign(9, 1.0 / 9.0);

  const FilteredSurface smooth = filter_surface(field, {.side = FilterSide::kS, .nesting_um = 20.0});

  // White noise of 0.6 * 9 um, averaged by both; variances of kernels add.
  const double deviation_px =
      std::hypot(20.0 * std::sqrt(std::numbers::ln2 / 2.0) / std::numbers::pi, std::sqrt((9.0 * 9.0 - 1.0) / 12.0));
  EXPECT_NEAR(smooth.surface.sigma_um.at(60, 60), 0.6 * 9.0 / (2.0 * std::sqrt(std::numbers::pi) * deviation_px), 0.02);
}

}  // namespace
}  // namespace fvd::metrology
