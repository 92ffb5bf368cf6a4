#include "core/metrology/artefact/hysteresis.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "core/base/error.hpp"
#include "core/metrology/uncertainty/random_normal.hpp"

namespace fvd::metrology {
namespace {

constexpr double kHole = std::numeric_limits<double>::quiet_NaN();

/// A rough part: white noise of the seed, 0.5 x 0.4 um.
HeightField part(int width = 120, int height = 90) {
  HeightField field{Plane<double>(width, height), {}, 0.5, 0.4, {}};
  RandomNormal random(3);
  for (double& z : field.z_um.pixels()) z = 5.0 * random.normal();
  return field;
}

HeightField raised(const HeightField& field, double offset_um, double slope_x, double slope_y, double noise_um) {
  HeightField moved = field.clone();
  RandomNormal random(8);
  for (int y = 0; y < field.height(); ++y) {
    for (int x = 0; x < field.width(); ++x) {
      moved.z_um.at(x, y) += offset_um + slope_x * field.x_um(x) + slope_y * field.y_um(y) + noise_um * random.normal();
    }
  }
  return moved;
}

TEST(Hysteresis, IsWhatTheScanDownwardsSeesHigher) {
  const HeightField up = part();
  const HeightField down = raised(up, 0.7, 0.002, -0.003, 0.0);

  const Hysteresis found = std::get<Hysteresis>(hysteresis(up, down));

  EXPECT_NEAR(found.mean_um, 0.7 + 0.002 * 30.0 - 0.003 * 18.0, 1e-10);
  EXPECT_NEAR(found.slope_x, 0.002, 1e-12);
  EXPECT_NEAR(found.slope_y, -0.003, 1e-12);
  EXPECT_NEAR(found.rest_um, 0.0, 1e-10);
  EXPECT_EQ(found.points, 120 * 90);
  EXPECT_EQ(found.valid_fraction, 1.0);
}

TEST(Hysteresis, HasTheRestThatNoPlaneExplains) {
  const HeightField up = part();
  HeightField down = raised(up, 0.7, 0.002, 0.0, 0.2);
  down.kernel = {{1.0 / 3, 1.0 / 3, 1.0 / 3}};
  HeightField correlated = up.clone();
  correlated.kernel = down.kernel;

  const Hysteresis found = std::get<Hysteresis>(hysteresis(up, down));
  const Hysteresis shared = std::get<Hysteresis>(hysteresis(correlated, down));

  EXPECT_NEAR(found.rest_um, 0.2, 0.005);
  EXPECT_NEAR(found.mean_um, 0.76, 4.0 * found.u_mean_um);
  EXPECT_NEAR(found.u_mean_um, found.rest_um / std::sqrt(10800.0), 1e-12);
  EXPECT_NEAR(shared.u_mean_um, 3.0 * found.u_mean_um, 1e-12);
}

TEST(Hysteresis, LooksAtPointsThatBothHave) {
  const HeightField up = part();
  HeightField down = raised(up, 0.7, 0.002, 0.0, 0.0);
  HeightField holed = up.clone();
  for (int x = 0; x < 120; ++x) holed.z_um.at(x, 0) = kHole;
  for (int x = 0; x < 60; ++x) down.z_um.at(x, 1) = kHole;
  Region region(120, 90, 1);
  for (int y = 0; y < 90; ++y) region.at(119, y) = 0;
  for (int y = 0; y < 90; ++y) down.z_um.at(119, y) += 1e3;

  const Hysteresis found = std::get<Hysteresis>(hysteresis(holed, down, region));

  EXPECT_EQ(found.points, 119 * 90 - 119 - 60);
  EXPECT_NEAR(found.valid_fraction, found.points / (119.0 * 90.0), 1e-12);
  EXPECT_NEAR(found.slope_x, 0.002, 1e-12);
  EXPECT_NEAR(found.rest_um, 0.0, 1e-10);
}

TEST(Hysteresis, IsRefusedWhereTooFewPointsAreSeenTwice) {
  const HeightField up = part();
  const HeightField small = part(33, 3);
  HeightField line = up.clone();
  for (int y = 1; y < 90; ++y) {
    for (int x = 0; x < 120; ++x) line.z_um.at(x, y) = kHole;
  }

  EXPECT_TRUE(std::holds_alternative<StudyRefusal>(hysteresis(small, small)));
  EXPECT_TRUE(std::holds_alternative<StudyRefusal>(hysteresis(up, line)));
  EXPECT_TRUE(std::holds_alternative<StudyRefusal>(hysteresis(up, up, Region(120, 90, 0))));
}

TEST(Hysteresis, NeedsScansOfOneShape) {
  const HeightField up = part();
  HeightField other = part();
  other.pitch_x_um = 0.6;

  EXPECT_THROW(static_cast<void>(hysteresis(up, other)), Error);
  EXPECT_THROW(static_cast<void>(hysteresis(up, part(119, 90))), Error);
  EXPECT_THROW(static_cast<void>(hysteresis(up, up, Region(10, 10, 1))), Error);
}

}  // namespace
}  // namespace fvd::metrology
