#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/metrology/filter/gaussian_kernel.hpp"
#include "core/metrology/filter/profile_filter.hpp"
#include "core/metrology/filter/surface_filter.hpp"

namespace fvd::metrology {
namespace {

constexpr FilterMethod kMethods[] = {FilterMethod::kGaussian, FilterMethod::kGaussianRegression1,
                                     FilterMethod::kGaussianRegression2};

/// What passes of a wave of height 1 whose top stands at point i.
double wave(double points_from_top, double wavelength_px) {
  return std::cos(2.0 * std::numbers::pi * points_from_top / wavelength_px);
}

double profile_passes(FilterMethod method, double nesting_px, double wavelength_px) {
  const int middle = sample_gaussian(method, nesting_px).reach_px();
  std::vector<double> z;
  for (int i = 0; i <= 2 * middle; ++i) z.push_back(wave(i - middle, wavelength_px));
  const FilteredProfile smooth =
      filter_profile(z, 0.5, {.side = FilterSide::kS, .nesting_um = 0.5 * nesting_px, .method = method});
  return smooth.z_um[static_cast<std::size_t>(middle)];
}

double surface_passes(FilterMethod method, double nesting_px, double wavelength_px) {
  const int middle = sample_gaussian(method, nesting_px).reach_px();
  // The mean needs half of its kernel; the others' result in the middle does not depend on the height.
  const int height = method == FilterMethod::kGaussian ? 2 * middle + 1 : 31;
  HeightField field{Plane<double>(2 * middle + 1, height), {}, 0.5, 0.5, {}};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x <= 2 * middle; ++x) field.z_um.at(x, y) = wave(x - middle, wavelength_px);
  }
  const FilteredSurface smooth =
      filter_surface(field, {.side = FilterSide::kS, .nesting_um = 0.5 * nesting_px, .method = method});
  return smooth.surface.z_um.at(middle, height / 2);
}

TEST(Transmission, OfProfilesIsThatOfTheStandardToAThousandth) {
  double worst = 0.0;
  for (const FilterMethod method : kMethods) {
    for (const double nesting_px : {5.0, 5.7, 12.0, 80.0, 300.0}) {
      for (const double ratio : {0.3, 0.4, 0.5, 0.7, 1.0, 1.5, 2.0, 3.0, 4.0}) {
        if (ratio * nesting_px < 3.0) continue;
        const double passes = profile_passes(method, nesting_px, ratio * nesting_px);
        const double error = std::abs(passes - filter_transmission(method, 1.0 / ratio));
        worst = std::max(worst, error);
        if (ratio * nesting_px >= 5.0) {
          EXPECT_LT(error, 2e-5) << nesting_px << " " << ratio;
        }
      }
    }
  }
  RecordProperty("filter_worst_profiles", std::to_string(worst));
  EXPECT_LT(worst, 0.001);
}

TEST(Transmission, OfSurfacesIsThatOfTheStandardToAThousandth) {
  double worst = 0.0;
  for (const FilterMethod method : kMethods) {
    for (const double nesting_px : {5.0, 23.0, 110.0, 300.0}) {
      for (const double ratio : {0.3, 0.6, 1.0, 2.0, 4.0}) {
        if (ratio * nesting_px < 3.0) continue;
        const double passes = surface_passes(method, nesting_px, ratio * nesting_px);
        const double error = std::abs(passes - filter_transmission(method, 1.0 / ratio));
        worst = std::max(worst, error);
        EXPECT_LT(error, ratio * nesting_px < 5.0 ? 0.001 : 2e-5) << nesting_px << " " << ratio;
      }
    }
  }
  RecordProperty("filter_worst_surfaces", std::to_string(worst));
}

TEST(Transmission, OfTheGaussianHasTheFiguresOfTheReferenceCase) {
  EXPECT_NEAR(profile_passes(FilterMethod::kGaussian, 100.0, 50.0), 0.0625, 1e-7);
  EXPECT_NEAR(profile_passes(FilterMethod::kGaussian, 100.0, 100.0), 0.5, 1e-7);
  EXPECT_NEAR(profile_passes(FilterMethod::kGaussian, 100.0, 200.0), 0.8408964, 1e-7);
}

TEST(Transmission, OfAWaveInTwoDirectionsIsTheProductOfBoth) {
  constexpr int kSize = 501;
  HeightField field{Plane<double>(kSize, kSize), {}, 1.0, 1.0, {}};
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) field.z_um.at(x, y) = 5.0 * wave(x - 250, 100.0) * wave(y - 250, 100.0);
  }

  const FilteredSurface smooth = filter_surface(field, {.side = FilterSide::kS, .nesting_um = 100.0});

  EXPECT_NEAR(smooth.surface.z_um.at(250, 250), 5.0 * 0.25, 1e-6);
  EXPECT_NEAR(smooth.surface.z_um.at(300, 250), -5.0 * 0.25, 1e-6);
}

TEST(Transmission, OfTheLongSideIsTheRest) {
  std::vector<double> z;
  for (int i = 0; i <= 400; ++i) z.push_back(wave(i - 200, 160.0));

  const FilteredProfile rest = filter_profile(z, 1.0, {.side = FilterSide::kL, .nesting_um = 80.0});

  EXPECT_NEAR(rest.z_um[200], 1.0 - 0.8408964, 1e-7);
}

}  // namespace
}  // namespace fvd::metrology
