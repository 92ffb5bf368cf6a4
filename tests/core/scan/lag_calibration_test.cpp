#include "core/scan/lag_calibration.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "tests/support/expect_error.hpp"

namespace fvd {
namespace {

/// A wavy surface with noise and some holes, all of it higher by `offset_um`.
HeightMap scanned(double offset_um, unsigned seed) {
  HeightMap map;
  map.height_m = Plane<float>(64, 48);
  map.mask = Plane<MaskReasons>(64, 48);
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0.0, 0.1);
  for (int y = 0; y < 48; ++y) {
    for (int x = 0; x < 64; ++x) {
      const double um = 20.0 * std::sin(x * 0.3) + 5.0 * y + offset_um + noise(random);
      map.height_m.at(x, y) = static_cast<float>(um * 1e-6);
      map.mask.at(x, y) = random() % 10 == 0 ? 1 : 0;
    }
  }
  return map;
}

TEST(LagCalibration, FindsTheOffsetOfTheClocksWithItsSign) {
  constexpr double kSpeed_um_per_s = 400.0;
  for (const double lag_us : {-900.0, 0.0, 250.0, 3000.0}) {
    const double shift_um = kSpeed_um_per_s * lag_us * 1e-6;
    const LagResult result = measure_lag(scanned(-shift_um, 1), scanned(shift_um, 2), kSpeed_um_per_s);
    EXPECT_NEAR(result.lag_us, lag_us, 4.0 * result.sd_us + 0.5) << lag_us;
    EXPECT_LT(result.sd_us, 10.0);
    EXPECT_GT(result.points, 2000);
  }
}

TEST(LagCalibration, RefusesWhatTellsNothing) {
  HeightMap holes = scanned(0.0, 1);
  for (auto& reasons : holes.mask.pixels()) reasons = 1;
  test::expect_error(ErrorCode::kTooFewValid, {"texture"}, [&] { (void)measure_lag(holes, scanned(0.0, 2), 100.0); });
  HeightMap small;
  small.height_m = Plane<float>(8, 8);
  small.mask = Plane<MaskReasons>(8, 8);
  test::expect_error(ErrorCode::kBadInput, {"shapes"}, [&] { (void)measure_lag(small, scanned(0.0, 2), 100.0); });
}

}  // namespace
}  // namespace fvd
