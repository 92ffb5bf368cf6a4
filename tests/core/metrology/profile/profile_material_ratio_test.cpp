#include "core/metrology/profile/profile_material_ratio.hpp"

#include <cmath>
#include <numbers>
#include <vector>

#include <boost/math/special_functions/erf.hpp>
#include <gtest/gtest.h>

namespace fvd::metrology {
namespace {

constexpr int kPoints = 20000;

template <typename Height>
std::vector<double> sorted(const Height& height) {
  std::vector<double> z;
  for (int i = 0; i < kPoints; ++i) z.push_back(height((i + 0.5) / kPoints));
  return z;
}

TEST(ProfileMaterialRatio, OfASineIsThatOfItsClosedForm) {
  const auto z = sorted([](double ratio) { return 5.0 * std::cos(std::numbers::pi * ratio); });

  const MaterialRatioCore core = material_ratio_core(z);

  EXPECT_NEAR(core.core_um, 8.637288, 2e-6);
  EXPECT_TRUE(core.tie);
  EXPECT_NEAR(core.upper_percent, 0.0, 1e-9);
  EXPECT_NEAR(core.lower_percent, 75.92982, 2e-5);
  EXPECT_EQ(core.peaks_um, 0.0);
  EXPECT_NEAR(core.valleys_um, 1.799273, 2e-6);
}

TEST(ProfileMaterialRatio, OfARampIsItsHeight) {
  const auto z = sorted([](double ratio) { return 10.0 * (1.0 - ratio); });

  const MaterialRatioCore core = material_ratio_core(z);

  EXPECT_NEAR(core.core_um, 10.0, 1e-7);
  EXPECT_NEAR(core.peaks_um, 0.0, 1e-7);
  EXPECT_NEAR(core.valleys_um, 0.0, 1e-7);
  EXPECT_NEAR(core.upper_percent, 0.0, 0.01);
  EXPECT_NEAR(core.lower_percent, 100.0, 0.01);
}

TEST(ProfileMaterialRatio, OfNormalHeightsIsThatOfItsClosedForm) {
  const auto z = sorted([](double ratio) { return std::numbers::sqrt2 * boost::math::erfc_inv(2.0 * ratio); });

  const MaterialRatioCore core = material_ratio_core(z);

  EXPECT_NEAR(core.core_um, 2.622003, 2e-6);
  EXPECT_NEAR(core.peaks_um, 0.9369847, 2e-4);
  EXPECT_NEAR(core.valleys_um, 0.9369847, 2e-4);
  EXPECT_NEAR(core.upper_percent, 9.492867, 2e-3);
  EXPECT_NEAR(core.lower_percent, 90.507133, 2e-3);
}

TEST(ProfileMaterialRatio, OfPlateausWithDeepValleysHasATallValleyAlone) {
  // 80 % slope gently by 1 um, the rest falls by 20.
  const auto z = sorted([](double ratio) { return ratio < 0.8 ? 1.0 - ratio : 0.2 - 100.0 * (ratio - 0.8); });

  const MaterialRatioCore core = material_ratio_core(z);

  EXPECT_NEAR(core.core_um, 1.0, 1e-6);
  EXPECT_FALSE(core.tie);  // one stretch is equally flat all along
  EXPECT_NEAR(core.lower_percent, 80.2, 0.01);
  EXPECT_NEAR(core.valleys_um, 19.8, 0.01);  // a triangle from 80.2 to 100 %
}

}  // namespace
}  // namespace fvd::metrology
