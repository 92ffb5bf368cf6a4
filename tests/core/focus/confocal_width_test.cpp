// The width of a confocal microscope's curve by its optics.
#include "core/focus/confocal_width.hpp"

#include <gtest/gtest.h>

#include "core/base/error.hpp"

namespace fvd {
namespace {

TEST(AConfocalWidth, IsThatOfTheApertureAndTheWavelength) {
  EXPECT_NEAR(confocal_width_um(0.8, 0.405), 0.449, 0.001);
  EXPECT_NEAR(confocal_width_um(0.8, 0.550), 0.609, 0.001);
  EXPECT_NEAR(confocal_width_um(0.95, 0.405), 0.261, 0.001);
  EXPECT_NEAR(confocal_width_um(0.95, 0.550), 0.354, 0.001);
  // Of a small aperture that of the paraxial formula, 0.886 lambda / NA^2.
  EXPECT_NEAR(confocal_width_um(0.05, 0.5), 0.886 * 0.5 / (0.05 * 0.05), 0.2);
  EXPECT_GT(confocal_width_um(0.8, 0.405, 1.33), confocal_width_um(0.8, 0.405));
}

TEST(AConfocalWidth, IsRefusedForOpticsThatThereAreNot) {
  for (const double na : {0.0, -0.1, 1.0, 1.2}) EXPECT_THROW((void)confocal_width_um(na, 0.5), Error) << na;
  EXPECT_THROW((void)confocal_width_um(0.5, 0.0), Error);
  EXPECT_THROW((void)confocal_width_um(0.5, 0.5, 0.9), Error);
}

}  // namespace
}  // namespace fvd
