#include "core/focus/fit/slice_sensitivity.hpp"

#include <algorithm>
#include <array>
#include <numeric>

#include <gtest/gtest.h>

namespace fvd {
namespace {

std::vector<double> even_slices() {
  std::vector<double> z_um;
  for (int i = 0; i < 21; ++i) z_um.push_back(-7.0 + 10.0 * i);
  return z_um;
}

constexpr double kWidth_um = 28.0;

TEST(SliceSensitivities, OfAPlateauSumToOneAndLieAtItsSlices) {
  const std::vector<double> z_um = even_slices();
  const std::array heights{WeightedHeight{50.0, 0.5}, WeightedHeight{50.1, 0.5}};

  const std::vector<double> found = slice_sensitivities(z_um, kWidth_um, heights);

  EXPECT_NEAR(std::accumulate(found.begin(), found.end(), 0.0), 1.0, 1e-6);
  for (std::size_t i = 0; i < z_um.size(); ++i) {
    if (z_um[i] >= 25.0 && z_um[i] <= 75.0) continue;
    EXPECT_EQ(found[i], 0.0) << z_um[i];
  }
}

TEST(SliceSensitivities, OfAStepSumToNothing) {
  const std::array heights{WeightedHeight{100.3, 1.0}, WeightedHeight{50.2, -1.0}};

  const std::vector<double> found = slice_sensitivities(even_slices(), kWidth_um, heights);

  EXPECT_NEAR(std::accumulate(found.begin(), found.end(), 0.0), 0.0, 1e-6);
  EXPECT_GT(std::inner_product(found.begin(), found.end(), found.begin(), 0.0), 0.3);
}

TEST(SliceSensitivities, OfASurfaceOverAllHeightsAreSpreadOverItsSlices) {
  std::vector<WeightedHeight> heights;
  for (int i = 0; i < 1000; ++i) heights.push_back({20.0 + 0.1 * i, 1e-3});

  const std::vector<double> found = slice_sensitivities(even_slices(), kWidth_um, heights);

  EXPECT_NEAR(std::accumulate(found.begin(), found.end(), 0.0), 1.0, 1e-6);
  EXPECT_LT(std::inner_product(found.begin(), found.end(), found.begin(), 0.0), 0.15);
}

TEST(SliceSensitivities, AreTheSameForFallingSlices) {
  std::vector<double> falling = even_slices();
  std::reverse(falling.begin(), falling.end());
  const std::array heights{WeightedHeight{52.0, 1.0}};

  std::vector<double> found = slice_sensitivities(falling, kWidth_um, heights);
  std::reverse(found.begin(), found.end());
  const std::vector<double> rising = slice_sensitivities(even_slices(), kWidth_um, heights);

  for (std::size_t i = 0; i < rising.size(); ++i) EXPECT_NEAR(found[i], rising[i], 1e-9);
}

TEST(SliceSensitivities, PassOverHeightsOutsideTheRange) {
  const std::array heights{WeightedHeight{-50.0, 1.0}, WeightedHeight{1e9, 1.0}, WeightedHeight{-7.0, 1.0}};

  const std::vector<double> found = slice_sensitivities(even_slices(), kWidth_um, heights);

  for (const double value : found) EXPECT_EQ(value, 0.0);
}

}  // namespace
}  // namespace fvd
