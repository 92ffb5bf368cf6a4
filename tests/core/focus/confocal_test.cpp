// A confocal microscope's curves: heights near the Cramer-Rao bound, and standard errors that are theirs.
#include <gtest/gtest.h>

#include "tests/bench/confocal_scans.hpp"

namespace fvd {
namespace {

struct Bound {
  double step_widths;
  double over_bound;
};

class AConfocalScan : public testing::TestWithParam<Bound> {};

TEST_P(AConfocalScan, ComesNearTheCramerRaoBoundAndKnowsHowNear) {
  const bench::ConfocalFigures found = bench::scan_confocal(GetParam().step_widths);
  EXPECT_LE(found.over_bound, GetParam().over_bound);
  EXPECT_GE(found.over_bound, 0.95);  // nothing is better than the bound
  EXPECT_GE(found.sigma_over_rms, 0.8);
  EXPECT_LE(found.sigma_over_rms, 1.25);
  EXPECT_GE(found.valid, 0.999);
}

INSTANTIATE_TEST_SUITE_P(Steps, AConfocalScan,
                         testing::Values(Bound{0.05, 1.20}, Bound{0.1, 1.20}, Bound{0.2, 1.18}, Bound{0.33, 1.20},
                                         Bound{0.5, 1.30}),
                         [](const auto& about) {
                           return "Of" + std::to_string(static_cast<int>(100.0 * about.param.step_widths + 0.5)) +
                                  "HundredthsOfAWidth";
                         });

TEST(AConfocalScanOfFineSteps, FindsTheWidthOfItsCurve) {
  EXPECT_NEAR(bench::scan_confocal(0.33).width_error, 0.0, 0.03);
}

}  // namespace
}  // namespace fvd
