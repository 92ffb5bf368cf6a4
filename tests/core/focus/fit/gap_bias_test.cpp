#include "core/focus/fit/gap_bias.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include <gtest/gtest.h>

#include "core/focus/fit/fit_reference.hpp"

namespace fvd {
namespace {

/// Slices of 10 um, the one at 50 um missing.
const std::vector<double> kHeights_um{0, 10, 20, 30, 40, 60, 70, 80, 90, 100};
constexpr double kExponent = 1.4;
constexpr double kWidth_um = 24.0;

double share(double away_um) {
  const double bend = (std::exp2(1.0 / kExponent) - 1.0) * 4.0 / (kWidth_um * kWidth_um);
  return std::pow(1.0 + bend * away_um * away_um, -kExponent);
}

/// The vertex of the five-sample fit and the peak's sample.
std::pair<double, std::uint16_t> fitted(double vertex_um) {
  std::size_t peak = 2;
  for (std::size_t k = 2; k + 2 < kHeights_um.size(); ++k) {
    if (std::abs(kHeights_um[k] - vertex_um) < std::abs(kHeights_um[peak] - vertex_um)) peak = k;
  }
  const auto sample = [&](std::size_t k) { return ReferenceSample{kHeights_um[k], share(kHeights_um[k] - vertex_um)}; };
  const ReferenceCurve curve{.peak = sample(peak),
                             .left = sample(peak - 1),
                             .right = sample(peak + 1),
                             .left2 = sample(peak - 2),
                             .right2 = sample(peak + 2)};
  return {fit_reference(curve)->z_um, static_cast<std::uint16_t>(peak)};
}

float corrected_um(double fitted_um, std::uint16_t index, const CurveShape& shape) {
  CurveRow row{};
  row.peak_index = &index;
  auto height_m = static_cast<float>(fitted_um * 1e-6);
  GapBias(kHeights_um, shape).correct(row, 1, &height_m);
  return height_m * 1e6F;
}

TEST(GapBias, TakesOffWhatAMissingSliceDoesToTheFit) {
  const CurveShape shape{.exponent = kExponent, .width_um = kWidth_um, .bias = {}};
  double worst_before = 0.0;
  for (double vertex_um = 31.0; vertex_um < 70.0; vertex_um += 0.7) {
    const auto [fit_um, index] = fitted(vertex_um);
    worst_before = std::max(worst_before, std::abs(fit_um - vertex_um));
    EXPECT_NEAR(static_cast<double>(corrected_um(fit_um, index, shape)), vertex_um, 0.03);
  }
  EXPECT_GT(worst_before, 0.3);
}

TEST(GapBias, LeavesHeightsAloneFarFromAGapAndWithoutAWidth) {
  const CurveShape shape{.exponent = kExponent, .width_um = kWidth_um, .bias = {}};
  EXPECT_FLOAT_EQ(corrected_um(13.0, 1, shape), 13.0F);
  EXPECT_FLOAT_EQ(corrected_um(43.0, 4, {}), 43.0F);
  EXPECT_TRUE(std::isnan(corrected_um(std::numeric_limits<double>::quiet_NaN(), 4, shape)));
}

}  // namespace
}  // namespace fvd
